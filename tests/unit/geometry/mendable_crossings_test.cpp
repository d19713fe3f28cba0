#include "common/geometry/patch_fill/mendable_crossings.h"

#include <gtest/gtest.h>

#include <array>

namespace strake {
namespace {

/// Squares that stand in n planes one way and in n the other: each passes through n others, in n *
/// n pairs. Beside them, squares that touch nothing.
PolyMesh crossed_squares(int n, int free) {
  PolyMesh mesh;
  const auto add = [&](const Vec3& a, const Vec3& along) {
    const Index first = mesh.vertex_count();
    const Vec3 up(0, 0, 1);
    mesh.positions.insert(mesh.positions.end(), {a, a + along, a + along + up, a + up});
    mesh.add_face(std::array<Index, 4>{first, first + 1, first + 2, first + 3});
  };
  for (int i = 0; i < n; ++i) add(Vec3(i + 0.5, 0, 0), Vec3(0, n, 0));
  for (int i = 0; i < n; ++i) add(Vec3(0, i + 0.5, 0.1), Vec3(n, 0, 0));
  for (int i = 0; i < free; ++i) add(Vec3(0, 0, 3.0 + 2 * i), Vec3(1, 0, 0));
  return mesh;
}

std::size_t mendable(const PolyMesh& mesh) {
  return mendable_crossings(mesh, mesh.positions).size();
}

TEST(MendableCrossings, AreFewOrInASmallShareOfTheFaces) {
  EXPECT_EQ(mendable(crossed_squares(10, 0)), 100u);    // few pairs
  EXPECT_EQ(mendable(crossed_squares(11, 0)), 0u);      // all faces cross, in 121 pairs
  EXPECT_EQ(mendable(crossed_squares(11, 198)), 121u);  // a tenth of the faces
  EXPECT_EQ(mendable(crossed_squares(71, 2000)), 0u);   // 5041 pairs
  EXPECT_EQ(mendable(crossed_squares(70, 2000)), 4900u);
}

}  // namespace
}  // namespace strake
