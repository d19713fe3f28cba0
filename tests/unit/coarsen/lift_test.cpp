#include "stages/lift/lift.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_lines.h"
#include "common/geometry/surface_point.h"
#include "tests/support/attributed.h"
#include "tests/support/chain.h"
#include "tests/support/import_support.h"
#include "tests/unit/coarsen/coarse_samples.h"

namespace strake {
namespace {

using coarsen_test::coarse_field;
using coarsen_test::coarsened;
using coarsen_test::thin_shell;

/// A result on the coarser mesh of a surface.
struct OnCoarser {
  TriMesh mesh;
  TriMesh coarse;
  QuadMesh quads;
};

OnCoarser remeshed(const PolyMesh& soup, Index coarse_vertices, std::int64_t vertices) {
  TriMesh mesh = support::import_tri_mesh(soup);
  support::Prepared working;
  working.mesh = coarsened(mesh, coarse_vertices);
  working.field = coarse_field(mesh, working.mesh);
  TraceOptions options;
  options.vertices = vertices;
  QuadMesh quads = support::mesh(working, support::trace(working, options));
  return {std::move(mesh), std::move(working.mesh), std::move(quads)};
}

PolyMesh sample_soup(SampleKind kind, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return make_sample(kind, options);
}

/// A vertex that lies nearer to another part has its foot on its own one.
TEST(LiftQuads, FeetStayOnTheirComponent) {
  constexpr Index kAcross = 12;
  constexpr double kApart = 0.1;
  PolyMesh sheets;
  for (const double z : {0.0, kApart}) {
    const auto first = static_cast<Index>(sheets.positions.size());
    for (Index i = 0; i <= kAcross; ++i) {
      for (Index j = 0; j <= kAcross; ++j) sheets.positions.emplace_back(i, j, z);
    }
    for (Index i = 0; i < kAcross; ++i) {
      for (Index j = 0; j < kAcross; ++j) {
        const Index at = first + i * (kAcross + 1) + j;
        sheets.add_face(std::array<Index, 4>{at, at + kAcross + 1, at + kAcross + 2, at + 1});
      }
    }
  }
  const TriMesh mesh = support::import_tri_mesh(sheets);
  const TriMesh coarse = coarsened(mesh, 150);
  QuadMesh quads;
  const double lower = -mesh.origin.z();
  for (Index f = 0; f < coarse.face_count(); ++f) {
    const SurfacePoint middle{f, {0.3, 0.3, 0.4}};
    if (std::abs(place_of(coarse, middle).z() - lower) > kApart / 2) continue;
    quads.mesh.positions.push_back(coarse.origin + place_of(coarse, middle) +
                                   Vec3(0, 0, 0.9 * kApart));
    quads.provenance.face.push_back(f);
    quads.provenance.barycentric.push_back(middle.barycentric);
    quads.provenance.lines.push_back({kNone, kNone});
  }
  quads.mesh.add_face(std::array<Index, 3>{0, 1, 2});
  const QuadMesh lifted = lift_quads(mesh, coarse, quads);
  for (Index v = 0; v < lifted.mesh.vertex_count(); ++v) {
    EXPECT_NEAR(place_of(mesh, foot_of(lifted.provenance, v)).z(), lower, 1e-9);
  }
}

TEST(LiftQuads, VerticesStayAndFeetAreNearThem) {
  const OnCoarser result = remeshed(sample_soup(SampleKind::ellipsoid, 40000), 2000, 200);
  const QuadMesh lifted = lift_quads(result.mesh, result.coarse, result.quads);
  EXPECT_EQ(lifted.mesh_id, result.mesh.id);
  EXPECT_EQ(lifted.mesh.positions, result.quads.mesh.positions);
  EXPECT_EQ(lifted.mesh.corners, result.quads.mesh.corners);
  double farthest = 0;
  for (Index v = 0; v < lifted.mesh.vertex_count(); ++v) {
    const Vec3 foot = result.mesh.origin + place_of(result.mesh, foot_of(lifted.provenance, v));
    // A T-joint may lie off the coarser mesh.
    const Vec3 before =
        result.coarse.origin + place_of(result.coarse, foot_of(result.quads.provenance, v));
    const Vec3& place = lifted.mesh.positions[v];
    farthest = std::max(farthest, (foot - place).norm() - (before - place).norm());
    EXPECT_NEAR(lifted.provenance.barycentric[v][0] + lifted.provenance.barycentric[v][1] +
                    lifted.provenance.barycentric[v][2],
                1, 1e-12);
  }
  // 2000 vertices leave edges of about 0.1, which miss the least radius, 0.3, by their square over
  // eight times that.
  EXPECT_LT(farthest, 0.1 * 0.1 / 8 / 0.3);
  EXPECT_GT(farthest, 0);
}

TEST(LiftQuads, OnLinesFeetAreTheVerticesThemselves) {
  const OnCoarser result = remeshed(sample_soup(SampleKind::part, 20000), 3000, 600);
  const QuadMesh lifted = lift_quads(result.mesh, result.coarse, result.quads);
  Index on_lines = 0;
  for (Index v = 0; v < lifted.mesh.vertex_count(); ++v) {
    const SurfacePoint before = foot_of(result.quads.provenance, v);
    const SurfacePoint after = foot_of(lifted.provenance, v);
    const bool was_on_line = !SurfaceLines(result.coarse).places(before).empty();
    const bool is_on_line = !SurfaceLines(result.mesh).places(after).empty();
    if (was_on_line) {
      ++on_lines;
      EXPECT_TRUE(is_on_line) << v;
      EXPECT_LT((place_of(result.mesh, after) - place_of(result.coarse, before)).norm(),
                1e-12 * result.mesh.diagonal);
    } else {
      EXPECT_FALSE(is_on_line) << v;
    }
  }
  EXPECT_GT(on_lines, 50);
}

// The other side is often nearer than what the coarser mesh misses.
TEST(LiftQuads, FeetStayOnTheirSideOfAShell) {
  const OnCoarser result = remeshed(thin_shell(0.004), 1200, 150);
  const QuadMesh lifted = lift_quads(result.mesh, result.coarse, result.quads);
  const FaceNormals fine(result.mesh);
  const FaceNormals coarse(result.coarse);
  for (Index v = 0; v < lifted.mesh.vertex_count(); ++v) {
    EXPECT_GT(fine[lifted.provenance.face[v]].dot(coarse[result.quads.provenance.face[v]]), 0) << v;
  }
}

TEST(LiftQuads, CarriesAttributes) {
  PolyMesh soup = sample_soup(SampleKind::torus, 20000);
  support::colour_linearly(soup);
  const OnCoarser result = remeshed(soup, 1500, 150);
  EXPECT_TRUE(result.quads.mesh.attributes.colour.empty());
  const QuadMesh lifted = lift_quads(result.mesh, result.coarse, result.quads);
  ASSERT_EQ(lifted.mesh.attributes.colour.size(), lifted.mesh.positions.size());
  for (std::size_t v = 0; v < lifted.mesh.positions.size(); ++v) {
    const Colour wanted = support::linear_colour(lifted.mesh.positions[v]);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(lifted.mesh.attributes.colour[v][i], wanted[i], 0.005);
  }
}

}  // namespace
}  // namespace strake
