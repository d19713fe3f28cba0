#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "common/core/error.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "common/geometry/topology/topology.h"
#include "tests/support/attributed.h"
#include "tests/support/chain.h"
#include "tests/support/import_support.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/line_sets.h"

namespace strake {
namespace {

QuadMesh mesh_of(const TriMesh& surface, const LineSet& lines) {
  SilentObserver observer;
  return mesh_lines(surface, lines, MeshOptions{}, observer).quads;
}

/// A valid surface of at most five sides with the topology of the input, and sound provenance.
void expect_same_topology(const TriMesh& surface, const QuadMesh& result) {
  const PolyTopology topology = analyse(result.mesh);
  EXPECT_TRUE(topology.is_oriented_manifold()) << topology.defects();
  EXPECT_EQ(topology.unused_vertices, 0);
  EXPECT_LE(topology.most_sides, 5);
  const Census before = census(surface);
  EXPECT_EQ(topology.components, before.components);
  EXPECT_EQ(topology.boundary_loops, before.boundary_loops);
  EXPECT_EQ(topology.genus, before.genus);
  ASSERT_EQ(result.provenance.face.size(), result.mesh.positions.size());
  ASSERT_EQ(result.provenance.barycentric.size(), result.mesh.positions.size());
  for (std::size_t v = 0; v < result.mesh.positions.size(); ++v) {
    const Index face = result.provenance.face[v];
    ASSERT_TRUE(face >= 0 && face < surface.face_count());
    const auto& b = result.provenance.barycentric[v];
    EXPECT_NEAR(b[0] + b[1] + b[2], 1, 1e-12);
    EXPECT_GE(*std::min_element(b.begin(), b.end()), -1e-12);
  }
}

Vec3 foot(const TriMesh& surface, const QuadMesh& result, Index v) {
  Vec3 p = surface.origin;
  for (int i = 0; i < 3; ++i) {
    p += result.provenance.barycentric[v][i] *
         surface.positions[surface.faces[result.provenance.face[v]][i]];
  }
  return p;
}

TEST(MeshLines, GivesTheGridThatItIsGiven) {
  SampleOptions options;
  options.faces = 2000;
  options.jitter = 1;
  const TriMesh surface = support::import_tri_mesh(make_sample(SampleKind::plane, options));
  constexpr int kColumns = 6;
  constexpr int kRows = 4;
  // Irrational places, so that no vertex lies on a line.
  const auto column = [](int i) { return -1 + 2 * (i + 1 + 0.1 / std::sqrt(2)) / (kColumns + 1); };
  const auto row = [](int j) { return -1 + 2 * (j + 1 - 0.1 / std::sqrt(3)) / (kRows + 1); };
  LineSet lines;
  for (int i = 0; i < kColumns; ++i) {
    add_level_lines(
        surface, [=](const Vec3& p) { return p.x() + surface.origin.x() - column(i); },
        LineFamily::minimum, lines);
  }
  for (int j = 0; j < kRows; ++j) {
    add_level_lines(
        surface, [=](const Vec3& p) { return p.y() + surface.origin.y() - row(j); },
        LineFamily::maximum, lines);
  }
  ASSERT_EQ(lines.line_count(), kColumns + kRows);
  set_spacing(surface, 2.0 / (kColumns + 1), lines);
  const QuadMesh result = mesh_of(surface, lines);
  expect_same_topology(surface, result);
  EXPECT_EQ(result.mesh.vertex_count(), (kColumns + 2) * (kRows + 2));
  EXPECT_EQ(analyse(result.mesh).quads, (kColumns + 1) * (kRows + 1));
  EXPECT_EQ(result.mesh.face_count(), (kColumns + 1) * (kRows + 1));

  const auto at = [](int n, const auto& inner) {
    std::vector<double> places = {-1, 1};
    for (int i = 0; i < n; ++i) places.push_back(inner(i));
    return places;
  };
  for (const double x : at(kColumns, column)) {
    for (const double y : at(kRows, row)) {
      const Vec3 corner(x, y, 0);
      Index found = kNone;
      for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
        if ((result.mesh.positions[v] - corner).norm() < 1e-12) found = v;
      }
      ASSERT_NE(found, kNone) << "no vertex at " << corner.transpose();
      EXPECT_LT((foot(surface, result, found) - corner).norm(), 1e-12);
      const auto& named = result.provenance.lines[found];
      if (std::abs(x) < 1 && std::abs(y) < 1) {
        ASSERT_TRUE(named[0] != kNone && named[1] != kNone);
        EXPECT_NE(named[0] < kColumns, named[1] < kColumns) << "a column and a row cross there";
      }
    }
  }
}

struct Case {
  SampleKind kind;
  std::int64_t vertices;
};

class Subsets : public ::testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(
    Samples, Subsets,
    ::testing::Values(Case{SampleKind::sphere, 300}, Case{SampleKind::torus, 400},
                      Case{SampleKind::open_cylinder, 300}, Case{SampleKind::cylinder, 300},
                      Case{SampleKind::ellipsoid, 300}, Case{SampleKind::hyperboloid, 300},
                      Case{SampleKind::saddle, 300}, Case{SampleKind::part, 1500}),
    [](const auto& test) { return sample_names()[static_cast<std::size_t>(test.param.kind)]; });

TEST_P(Subsets, OfTracedLinesKeepTheTopology) {
  SampleOptions sample;
  sample.faces = 8000;
  const support::Prepared prepared = support::prepare(make_sample(GetParam().kind, sample));
  TraceOptions options;
  options.vertices = GetParam().vertices;
  const LineSet lines = support::trace(prepared, options);
  std::mt19937_64 random(1);
  for (const double kept : {1.0, 0.8, 0.5, 0.3, 0.1, 0.02, 0.0}) {
    for (int round = 0; round < 3; ++round) {
      SCOPED_TRACE(::testing::Message() << "share of lines kept " << kept << ", round " << round);
      const LineSet some = subset(lines, [&](Index l) {
        const bool barrier =
            lines.family[l] == LineFamily::boundary || lines.family[l] == LineFamily::feature;
        return barrier || std::uniform_real_distribution<double>(0, 1)(random) < kept;
      });
      ASSERT_NO_THROW(expect_same_topology(prepared.mesh, mesh_of(prepared.mesh, some)));
      if (kept == 0.0 || kept == 1.0) break;
    }
  }
}

/// Between two rulings a ring is half a circle: straight edges there would cut through the bore.
TEST(MeshLines, RingsStayAroundABore) {
  SampleOptions sample;
  sample.faces = 4000;
  const TriMesh bore = support::plain_tri_mesh(make_sample(SampleKind::open_cylinder, sample));
  LineSet lines;
  for (const double height : {-0.4001, 0.0001, 0.4001}) {
    add_level_lines(
        bore, [&](const Vec3& p) { return p.z() - height; }, LineFamily::maximum, lines);
  }
  add_level_lines(
      bore, [](const Vec3& p) { return p.y() + 1e-4; }, LineFamily::minimum, lines);
  set_spacing(bore, 0.8, lines);
  const QuadMesh result = mesh_of(bore, lines);
  expect_same_topology(bore, result);
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    const std::span<const Index> face = result.mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3 middle =
          (result.mesh.positions[face[i]] + result.mesh.positions[face[(i + 1) % face.size()]]) / 2;
      EXPECT_GT(middle.head<2>().norm(), 0.3 * kCylinderRadius) << "face " << f;
    }
  }
}

TEST(MeshLines, KeepsOneFamilyAlone) {
  SampleOptions sample;
  sample.faces = 4000;
  for (const SampleKind kind : {SampleKind::torus, SampleKind::open_cylinder}) {
    const support::Prepared prepared = support::prepare(make_sample(kind, sample));
    TraceOptions options;
    options.vertices = 300;
    const LineSet lines = support::trace(prepared, options);
    for (const LineFamily family : {LineFamily::minimum, LineFamily::maximum}) {
      const LineSet one = subset(lines, [&](Index l) { return lines.family[l] != family; });
      ASSERT_NO_THROW(expect_same_topology(prepared.mesh, mesh_of(prepared.mesh, one)));
    }
  }
}

TEST(MeshLines, KeepsComponentsWithoutAnyLine) {
  SampleOptions sample;
  sample.faces = 2000;
  const PolyMesh soup = support::together(
      make_sample(SampleKind::torus, sample),
      support::transformed(make_sample(SampleKind::sphere, sample), Mat3::Identity(), {5, 0, 0}));
  const support::Prepared prepared = support::prepare(soup);
  ASSERT_EQ(census(prepared.mesh).components, 2);
  TraceOptions options;
  options.vertices = 600;
  const LineSet lines = support::trace(prepared, options);
  const std::vector<Index> component = face_components(prepared.mesh);
  for (const Index bare : {0, 1}) {
    const LineSet some = subset(lines, [&](Index l) {
      const LinePoint& p = lines.points[lines.offsets[l]];
      return component[TriMesh::face_of(p.halfedge)] != bare;
    });
    ASSERT_LT(some.line_count(), lines.line_count());
    ASSERT_NO_THROW(expect_same_topology(prepared.mesh, mesh_of(prepared.mesh, some)));
  }
}

/// Needles of two hundred sizes and directions, far thinner than lines are apart.
TEST(MeshLines, KeepsASpaceInsideComponentsWithoutLines) {
  SampleOptions sample;
  sample.faces = 2000;
  PolyMesh soup = make_sample(SampleKind::sphere, sample);
  PolyMesh cube = support::labelled_cube(8);
  cube.attributes = {};
  for (int i = 0; i < 200; ++i) {
    const Mat3 turn = Eigen::AngleAxisd(i, Vec3(1, i % 7, i % 3).normalized()).toRotationMatrix();
    const double length = 0.001 * std::pow(1.01, i);
    const Vec3 thin(length / 2, 0.01 * length, 0.01 * length);
    soup = support::together(soup, support::transformed(cube, turn * thin.asDiagonal(),
                                                        {3 + 0.05 * (i % 15), 0.05 * (i / 15), 0}));
  }
  const support::Prepared prepared = support::prepare(soup);
  TraceOptions options;
  options.vertices = 600;
  const QuadMesh quads = support::mesh(prepared, support::trace(prepared, options));
  // No two faces have the same corners.
  std::set<std::set<Index>> corners;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    const std::span<const Index> face = quads.mesh.face(f);
    EXPECT_TRUE(corners.emplace(face.begin(), face.end()).second) << "face " << f;
  }
}

TEST(MeshLines, TurnsNoComponentInsideOut) {
  SampleOptions sample;
  sample.faces = 500;
  sample.jitter = 0.5;
  PolyMesh soup;
  for (int i = 0; i < 100; ++i) {
    sample.seed = i;
    soup = support::together(
        soup, support::transformed(make_sample(SampleKind::sphere, sample), Mat3::Identity(),
                                   {3.0 * (i % 10), 3.0 * (i / 10), 0}));
  }
  const support::Prepared prepared = support::prepare(soup);
  TraceOptions options;
  options.vertices = 400;
  const QuadMesh quads = support::mesh(prepared, support::trace(prepared, options));
  const std::vector<Index> component = face_components(prepared.mesh);
  std::map<Index, double> volumes;  // of components
  const std::vector<Vec3>& p = quads.mesh.positions;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    const std::span<const Index> face = quads.mesh.face(f);
    double& volume = volumes[component[quads.provenance.face[face[0]]]];
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      volume += p[face[0]].dot(p[face[i]].cross(p[face[i + 1]])) / 6;
    }
  }
  EXPECT_EQ(volumes.size(), 100u);
  for (const auto& [c, volume] : volumes) EXPECT_GT(volume, 0) << "component " << c;
}

/// Of a component without lines, which are `spacing` apart.
QuadMesh small_component(const TriMesh& surface, double spacing) {
  LineSet lines;
  lines.offsets = {0};
  set_spacing(surface, spacing, lines);
  return mesh_of(surface, lines);
}

/// The volume of a closed mesh whose faces are cut into fans.
double volume_of(const PolyMesh& mesh) {
  double volume = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      volume +=
          mesh.positions[face[0]].dot(mesh.positions[face[i]].cross(mesh.positions[face[i + 1]])) /
          6;
    }
  }
  return volume;
}

TEST(MeshLines, MakesAsManyCellsOfASmallSphereAsLinesWould) {
  SampleOptions sample;
  sample.faces = 2000;
  const TriMesh surface = support::import_tri_mesh(make_sample(SampleKind::sphere, sample));
  for (const double spacing : {0.4, 0.6, 0.9, 1.2}) {
    SCOPED_TRACE(spacing);
    const QuadMesh result = small_component(surface, spacing);
    expect_same_topology(surface, result);
    const double cells = 4 * std::numbers::pi / (spacing * spacing);
    EXPECT_NEAR(result.mesh.vertex_count(), cells + 2, 2 + 0.25 * cells);
    // More than that of an octahedron in the sphere, which has the fewest corners of them all.
    EXPECT_GT(volume_of(result.mesh), 4.0 / 3);
  }
}

TEST(MeshLines, LeavesTheRimsOfASmallCylinder) {
  SampleOptions sample;
  sample.faces = 2000;
  const support::Prepared prepared = support::prepare(make_sample(SampleKind::cylinder, sample));
  const LineSet all = support::trace(prepared);
  LineSet rims = subset(all, [&](Index l) { return all.family[l] == LineFamily::feature; });
  ASSERT_EQ(rims.line_count(), 2);
  set_spacing(prepared.mesh, 1.2, rims);
  const QuadMesh result = mesh_of(prepared.mesh, rims);
  expect_same_topology(prepared.mesh, result);
  double bottom = std::numeric_limits<double>::infinity();
  double top = -bottom;
  for (const Vec3& p : prepared.mesh.positions) {
    bottom = std::min(bottom, (p + prepared.mesh.origin).z());
    top = std::max(top, (p + prepared.mesh.origin).z());
  }
  const auto rim = [&](double z) {
    return std::ranges::count_if(result.mesh.positions, [&](const Vec3& p) {
      return std::abs(p.z() - z) < 1e-9 && std::abs(p.head<2>().norm() - 1) < 1e-6;
    });
  };
  EXPECT_GE(rim(bottom), 4);
  EXPECT_GE(rim(top), 4);
}

/// A pipe with two rulings, whatever way it looks: the cells between them are half of its wall, and
/// a little less or more than that.
TEST(MeshLines, ClosesNoEndOfAPipeFromItsWall) {
  SampleOptions sample;
  sample.faces = 3000;
  const PolyMesh pipe = make_sample(SampleKind::cylinder, sample);
  for (const double turned : {1.0, -1.0}) {
    const PolyMesh soup = support::transformed(pipe, Vec3(1, 1, turned).asDiagonal(), Vec3::Zero());
    const support::Prepared prepared = support::prepare(soup);
    const LineSet all = support::trace(prepared);
    for (const double x : {0.0004, 0.2}) {
      SCOPED_TRACE(::testing::Message() << "x " << x << ", turned " << turned);
      LineSet lines = subset(all, [&](Index l) { return all.family[l] == LineFamily::feature; });
      add_level_lines(
          prepared.mesh, [&](const Vec3& p) { return p.x() + prepared.mesh.origin.x() - x; },
          LineFamily::minimum, lines);
      set_spacing(prepared.mesh, 1, lines);
      MeshOptions options;
      options.odd_price = 0;
      options.valence_price = 0;
      const QuadMesh result = support::mesh(prepared, lines, options);
      expect_same_topology(prepared.mesh, result);
      EXPECT_GT(volume_of(result.mesh) / volume_of(soup), 0.85);
    }
  }
}

TEST(MeshLines, RefusesChordsThatDoNotJoinTwoSidesOfTheirFace) {
  SampleOptions sample;
  sample.faces = 500;
  const TriMesh surface = support::import_tri_mesh(make_sample(SampleKind::sphere, sample));
  const auto expect_refusal = [&](const std::vector<LinePoint>& points, Index face) {
    LineSet lines;
    add_line(lines, points, {face});
    set_spacing(surface, 0.2, lines);
    EXPECT_THROW(mesh_of(surface, lines), PreconditionError);
  };
  expect_refusal({{0, 0.3}, {0, 0.6}}, 0);            // along an edge
  expect_refusal({{0, 0.3}, {1, 0.6}}, 1);            // of another face
  expect_refusal({{0, 0.0}, {0, 0.6}}, 0);            // corner to an edge beside it
  expect_refusal({{0, 0.0}, {2, 0.6}}, 0);            // to the other one
  expect_refusal({{0, 0.0}, {1, 0.0}}, 0);            // corner to corner
  expect_refusal({{0, 0.5}, {3 * 200 + 1, 0.5}}, 0);  // far apart
  LineSet proper;
  add_line(proper, {{0, 0.3}, {1, 0.6}}, {0});
  set_spacing(surface, 0.2, proper);
  EXPECT_NO_THROW(mesh_of(surface, proper));
}

}  // namespace
}  // namespace strake
