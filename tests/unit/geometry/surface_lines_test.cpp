#include "common/geometry/surface_lines.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A ring of six faces between an outer triangle and an inner one of this size.
TriMesh ring(double inner) {
  PolyMesh faces;
  const std::array<Vec3, 3> corners = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
  for (const Vec3& p : corners) faces.positions.push_back(p);
  for (const Vec3& p : corners) faces.positions.push_back(inner * p);
  for (Index i = 0; i < 3; ++i) {
    const Index next = (i + 1) % 3;
    faces.add_face(std::array<Index, 3>{i, next, 3 + next});
    faces.add_face(std::array<Index, 3>{i, 3 + next, 3 + i});
  }
  return support::plain_tri_mesh(faces);
}

/// On the side from corner to corner + 1: of the outer triangle, or of the inner one.
SurfacePoint on_outer(Index corner, double share) { return {2 * corner, {1 - share, share, 0}}; }
SurfacePoint on_inner(Index corner, double share) {
  return {2 * corner + 1, {0, share, 1 - share}};
}

TEST(SurfaceLines, LeadAroundTheBoundary) {
  const TriMesh mesh = ring(0.5);
  const SurfaceLines lines(mesh);
  EXPECT_TRUE(lines.has_along(on_outer(0, 0.2), on_outer(0, 0.7)));
  EXPECT_TRUE(lines.has_along(on_outer(0, 0.7), on_outer(0, 0.2)));
  EXPECT_TRUE(lines.has_along(on_inner(0, 0.9), on_inner(1, 0.1)));
  EXPECT_FALSE(lines.has_along(on_outer(0, 0.5), on_inner(0, 0.5)));
  // Over two corners, the shorter way around.
  EXPECT_EQ(lines.way_between(on_outer(0, 0.9), on_outer(2, 0.1), 100).size(), 4u);
  EXPECT_TRUE(lines.way_between(on_outer(0, 0.9), on_outer(2, 0.1), 2).empty());
}

/// Ways around a loop of no length never get too long.
TEST(SurfaceLines, EndOnALoopWithoutLength) {
  const TriMesh mesh = ring(0);
  const SurfaceLines lines(mesh);
  EXPECT_FALSE(lines.has_along(on_inner(0, 0.5), on_outer(0, 0.5)));
  EXPECT_TRUE(lines.way_between(on_inner(1, 0.5), on_outer(2, 0.5), 1).empty());
}

}  // namespace
}  // namespace strake
