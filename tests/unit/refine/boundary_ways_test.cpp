#include "stages/refine/boundary_ways.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/result_cases.h"

namespace strake {
namespace {

/// A unit square with four teeth of 0.1 on its upper side, all of whose boundary vertices are
/// corners.
TriMesh toothed() {
  TriMesh mesh = support::toothed_sheet(4, 1, 0.1).mesh;
  std::ranges::fill(mesh.is_corner, 1);
  return mesh;
}

SurfacePoint tip(Index tooth) { return {2 * 4 * 4 + tooth, {0, 1, 0}}; }
/// On the right side of a tooth, or its left one.
SurfacePoint on_right(Index tooth, double share) {
  return {2 * 4 * 4 + tooth, {1 - share, share, 0}};
}
SurfacePoint on_left(Index tooth, double share) {
  return {2 * 4 * 4 + tooth, {0, 1 - share, share}};
}

std::vector<Vec3> places(const TriMesh& mesh, const std::vector<SurfaceLines::Place>& way) {
  std::vector<Vec3> result;
  for (const SurfaceLines::Place& at : way) result.push_back(SurfaceLines(mesh).position(at));
  return result;
}

TEST(BoundaryWays, PassCorners) {
  const TriMesh mesh = toothed();
  const BoundaryWays ways(mesh);
  // From right to left the surface lies on the left: over valley and tip to valley and tip.
  const std::vector<Vec3> way = places(mesh, ways.way(tip(3), tip(1)));
  ASSERT_EQ(way.size(), 5U);
  for (std::size_t i = 0; i < way.size(); ++i) {
    EXPECT_NEAR(way[i].x() - way[0].x(), -0.125 * double(i), 1e-12);
    EXPECT_NEAR(way[i].y() - way[0].y(), i % 2 == 0 ? 0 : -0.1, 1e-12);
  }
}

TEST(BoundaryWays, BeginAndEndWithinEdges) {
  const TriMesh mesh = toothed();
  const BoundaryWays ways(mesh);
  EXPECT_EQ(ways.way(on_right(2, 0.2), on_right(2, 0.7)).size(), 2U);
  EXPECT_EQ(ways.way(on_right(2, 0.2), on_left(2, 0.7)).size(), 3U);
  EXPECT_EQ(ways.way(on_right(2, 0.2), on_left(1, 0.7)).size(), 5U);
}

TEST(BoundaryWays, LeadTheShorterWayInItsSense) {
  const TriMesh mesh = toothed();
  const BoundaryWays ways(mesh);
  EXPECT_TRUE(ways.way(tip(1), tip(3)).empty());
  EXPECT_TRUE(ways.way(on_right(2, 0.7), on_right(2, 0.2)).empty());
  EXPECT_TRUE(ways.way(tip(1), tip(1)).empty());
  const SurfacePoint inside{0, {0.4, 0.3, 0.3}};
  EXPECT_TRUE(ways.way(tip(1), inside).empty());
  EXPECT_TRUE(ways.way(inside, tip(1)).empty());
}

}  // namespace
}  // namespace strake
