#include "stages/decimate/decimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "common/geometry/topology/topology.h"
#include "tests/support/import_support.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/decimate/decimate_samples.h"

namespace strake {
namespace {

/// The cube [0, 1]^3, each side of n x n squares cut into triangles.
PolyMesh cube(int n) {
  PolyMesh mesh;
  std::map<std::array<int, 3>, Index> vertices;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [entry, is_new] = vertices.try_emplace(at, mesh.vertex_count());
    if (is_new) mesh.positions.push_back(Vec3(at[0], at[1], at[2]) / n);
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int level : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> place = {};
            place[axis] = level;
            place[(axis + 1) % 3] = level == n ? u : v;
            place[(axis + 2) % 3] = level == n ? v : u;
            return vertex(place);
          };
          const Index a = at(i, j);
          const Index b = at(i + 1, j);
          const Index c = at(i + 1, j + 1);
          const Index d = at(i, j + 1);
          mesh.add_face(std::vector<Index>{a, b, c});
          mesh.add_face(std::vector<Index>{a, c, d});
        }
      }
    }
  }
  return mesh;
}

QuadMesh decimated(const TriMesh& mesh, std::int64_t vertices, Report* report = nullptr) {
  DecimateOptions options;
  options.vertices = vertices;
  SilentObserver observer;
  DecimateResult result = decimate_to_quads(mesh, options, observer);
  if (report != nullptr) *report = result.report;
  return result.quads;
}

TEST(DecimateToQuads, ACubeOfManyFacesIsSixQuads) {
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(1e6, -2e6, 3e6)}) {
    PolyMesh input = cube(6);
    for (Vec3& p : input.positions) p += shift;
    const PolyMesh result = decimated(support::import_tri_mesh(input), 8).mesh;
    ASSERT_EQ(result.vertex_count(), 8);
    ASSERT_EQ(result.face_count(), 6);
    for (Index f = 0; f < 6; ++f) EXPECT_EQ(result.face(f).size(), 4u);
    for (const Vec3& p : result.positions) {
      for (int i = 0; i < 3; ++i) {
        const double x = p[i] - shift[i];
        EXPECT_TRUE(x == 0 || x == 1) << x;
      }
    }
  }
}

/// A prism around z, its sides cut across.
PolyMesh prism(int sides, double radius, double length, int rings) {
  PolyMesh mesh;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                  length * j / rings);
    }
  }
  const auto at = [&](int i, int j) { return static_cast<Index>(j * sides + i % sides); };
  for (int i = 0; i < sides; ++i) {
    for (int j = 0; j < rings; ++j) {
      mesh.add_face(std::vector<Index>{at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.add_face(std::vector<Index>{at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  for (int i = 1; i + 1 < sides; ++i) {
    mesh.add_face(std::vector<Index>{at(0, 0), at(i + 1, 0), at(i, 0)});
    mesh.add_face(std::vector<Index>{at(0, rings), at(i, rings), at(i + 1, rings)});
  }
  return mesh;
}

// However long its sides are: what lies in their edges goes before these.
TEST(DecimateToQuads, APrismOfManyFacesIsExact) {
  for (const double length : {2.0, 10.0, 50.0}) {
    const TriMesh mesh = support::import_tri_mesh(prism(24, 1, length, 6));
    const QuadMesh quads = decimated(mesh, 48);
    EXPECT_EQ(quads.mesh.vertex_count(), 48);
    const ErrorMap errors =
        measure_cells(ComparedSurfaces(mesh, quads), {.rows = 4, .input_step = 0.25});
    EXPECT_LT(errors.largest, 1e-9 * length) << length;
  }
}

TEST(DecimateToQuads, KeepsTheTopology) {
  for (const SampleKind kind : {SampleKind::sphere, SampleKind::torus, SampleKind::open_cylinder,
                                SampleKind::saddle, SampleKind::part}) {
    const TriMesh mesh = sample(kind, 9000);
    const Census wanted = census(mesh);
    const QuadMesh result = decimated(mesh, 300);
    EXPECT_EQ(result.mesh.vertex_count(), 300);
    const PolyTopology topology = analyse(result.mesh);
    EXPECT_TRUE(topology.is_oriented_manifold()) << topology.defects();
    EXPECT_EQ(topology.euler, wanted.euler_characteristic);
    EXPECT_EQ(topology.boundary_loops, wanted.boundary_loops);
    EXPECT_EQ(topology.triangles + topology.quads, topology.faces);
    // Most of the faces are quads: in pairs two thirds of the faces leave a fifth of the triangles.
    EXPECT_GT(topology.quads, 2 * topology.triangles);
    for (std::size_t v = 0; v < result.mesh.positions.size(); ++v) {
      Vec3 foot = mesh.origin;
      for (int i = 0; i < 3; ++i) {
        foot += result.provenance.barycentric[v][i] *
                mesh.positions[mesh.faces[result.provenance.face[v]][i]];
      }
      EXPECT_EQ(foot, result.mesh.positions[v]);
    }
  }
}

// Seven vertices are the fewest of a torus.
TEST(DecimateToQuads, WarnsWhereTheTopologyNeedsMoreVertices) {
  const TriMesh mesh = sample(SampleKind::torus, 3000);
  Report report;
  const QuadMesh result = decimated(mesh, 4, &report);
  EXPECT_GE(result.mesh.vertex_count(), 7);
  EXPECT_EQ(analyse(result.mesh).euler, 0);
  EXPECT_EQ(report.warnings().size(), 1u);
}

// Edges of length h leave a sphere by h^2 / 8, and there are as many vertices as 1 / h^2.
TEST(DecimateToQuads, DistanceIsInverseToTheCount) {
  const TriMesh mesh = sample(SampleKind::sphere, 40000);
  std::vector<double> counts;
  std::vector<double> errors;
  for (const std::int64_t count : {100, 200, 400, 800}) {
    const QuadMesh result = decimated(mesh, count);
    counts.push_back(static_cast<double>(count));
    errors.push_back(measure_cells(ComparedSurfaces(mesh, result)).rms);
  }
  EXPECT_NEAR(support::observed_order(counts, errors), -1, 0.15);
}

TEST(DecimateToQuads, DoesNotDependOnTheUnit) {
  SampleOptions options;
  options.faces = 4000;
  const PolyMesh input = make_sample(SampleKind::ellipsoid, options);
  const QuadMesh a = decimated(support::import_tri_mesh(input), 120);
  // A power of two changes no mantissa. Costs go by the fourth power, beyond single precision.
  for (const double unit : {1024.0, std::exp2(45), std::exp2(-45)}) {
    const PolyMesh other = support::transformed(input, unit * Mat3::Identity());
    const QuadMesh b = decimated(support::import_tri_mesh(other), 120);
    EXPECT_EQ(a.mesh.corners, b.mesh.corners) << unit;
    ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size()) << unit;
    for (std::size_t v = 0; v < a.mesh.positions.size(); ++v) {
      EXPECT_EQ(Vec3(unit * a.mesh.positions[v]), b.mesh.positions[v]);
    }
  }
}

}  // namespace
}  // namespace strake
