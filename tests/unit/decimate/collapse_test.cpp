#include "stages/decimate/collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "common/geometry/samples/samples.h"
#include "tests/support/import_support.h"
#include "tests/unit/decimate/decimate_samples.h"

namespace strake {
namespace {

CoarseSurface collapsed(const TriMesh& mesh, Index count) {
  SilentObserver observer;
  return collapse_to(mesh, count, observer);
}

TEST(CollapseTo, GivesTheCountWithVerticesOfTheSurface) {
  const TriMesh mesh = sample(SampleKind::ellipsoid, 4000);
  const CoarseSurface coarse = collapsed(mesh, 150);
  ASSERT_EQ(coarse.positions.size(), 150u);
  ASSERT_EQ(coarse.faces.size(), 2 * 150u - 4);  // Euler, for a sphere of triangles
  const std::set<Index> different(coarse.vertex.begin(), coarse.vertex.end());
  EXPECT_EQ(different.size(), 150u);
  for (std::size_t v = 0; v < coarse.vertex.size(); ++v) {
    EXPECT_EQ(coarse.positions[v], mesh.positions[coarse.vertex[v]]);
  }
}

// The rims of a cylinder stay two rings of edges between vertices on them.
TEST(CollapseTo, KeepsFeatureLines) {
  const TriMesh mesh = sample(SampleKind::cylinder, 6000);
  const CoarseSurface coarse = collapsed(mesh, 60);
  std::map<Index, int> ends;  // vertices of barriers, with the number of half-edges there
  for (std::size_t h = 0; h < coarse.is_barrier.size(); ++h) {
    if (coarse.is_barrier[h] == 0) continue;
    for (const std::size_t i : {h % 3, (h + 1) % 3}) ++ends[coarse.faces[h / 3][i]];
  }
  ASSERT_FALSE(ends.empty());
  for (const auto& [v, count] : ends) {
    EXPECT_EQ(count, 4) << v;  // of two edges
    const Vec3 p = coarse.positions[v] + mesh.origin;
    EXPECT_NEAR(std::hypot(p.x(), p.y()), kCylinderRadius, 1e-9);
    EXPECT_NEAR(std::abs(p.z()), kCylinderHalfHeight, 1e-9);
  }
  // A vertex on a rim serves cap and side, so most are there.
  EXPECT_GT(ends.size(), coarse.positions.size() / 2);
}

/// Corners off all lines, as tips are, go at last, too.
TEST(CollapseTo, GivesUpCornersWhereNothingElseIsLeft) {
  TriMesh mesh = sample(SampleKind::ellipsoid, 2000);
  for (Index v = 0; v < mesh.vertex_count(); v += 5) mesh.is_corner[v] = 1;
  const auto corners = std::ranges::count(mesh.is_corner, 1);
  ASSERT_GT(corners, 100);
  const CoarseSurface with = collapsed(mesh, static_cast<Index>(corners + 20));
  EXPECT_EQ(std::ranges::count_if(with.vertex, [&](Index v) { return mesh.is_corner[v] != 0; }),
            corners);
  EXPECT_EQ(collapsed(mesh, 40).positions.size(), 40u);
}

TEST(CollapseTo, KeepsTheBoundary) {
  const TriMesh mesh = sample(SampleKind::open_cylinder, 3000);
  const CoarseSurface coarse = collapsed(mesh, 40);
  std::array<int, 2> sides = {0, 0};  // of the lower and the upper rim
  for (std::size_t h = 0; h < coarse.is_barrier.size(); ++h) {
    if (coarse.is_barrier[h] == 0) continue;
    const Vec3 p = coarse.positions[coarse.faces[h / 3][h % 3]] + mesh.origin;
    EXPECT_NEAR(std::abs(p.z()), kCylinderHalfHeight, 1e-9);
    ++sides[p.z() > 0 ? 1 : 0];
  }
  EXPECT_GT(*std::ranges::min_element(sides), 2);
}

}  // namespace
}  // namespace strake
