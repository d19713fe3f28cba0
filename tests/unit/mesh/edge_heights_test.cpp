#include "stages/mesh/edge_heights.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <vector>

#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A square in the plane z = 0, as two triangles.
TriMesh unit_square() {
  PolyMesh soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  soup.add_face(std::array<Index, 3>{0, 1, 2});
  soup.add_face(std::array<Index, 3>{0, 2, 3});
  return support::plain_tri_mesh(soup);
}

/// Over a plane they are known; and there are more edges than are remembered, so that each takes
/// the place of another.
TEST(EdgeHeights, AreThoseOfEveryEdgeHoweverManyThereAre) {
  const TriMesh mesh = unit_square();
  const EdgeHeights heights(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> within(0, 1);
  std::vector<Vec3> ends;
  for (int i = 0; i < 300; ++i) ends.emplace_back(within(random), within(random), within(random));
  tbb::parallel_for(std::size_t{0}, 2 * ends.size() * ends.size(), [&](std::size_t i) {
    const Vec3& a = ends[i / ends.size() % ends.size()];
    const Vec3& b = ends[i % ends.size()];
    const double highest = std::max(0.75 * a.z() + 0.25 * b.z(), 0.25 * a.z() + 0.75 * b.z());
    EXPECT_NEAR(heights.at(a, b), highest, 1e-12);
  });
}

TEST(EdgeHeights, AreZeroAlongTheSurface) {
  const TriMesh mesh = unit_square();
  const EdgeHeights heights(mesh);
  EXPECT_EQ(heights.at(Vec3(0, 0, 0), Vec3(1, 0.5, 0)), 0);
  EXPECT_EQ(heights.at(Vec3::Zero(), Vec3::Zero()), 0);
}

TEST(EdgeHeights, AnEdgeWithoutLengthAtTheOriginIsMeasured) {
  PolyMesh soup;
  soup.positions = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  soup.add_face(std::array<Index, 3>{0, 1, 2});
  const TriMesh mesh = support::plain_tri_mesh(soup);
  EXPECT_NEAR(EdgeHeights(mesh).at(Vec3::Zero(), Vec3::Zero()), 2, 1e-12);
}

}  // namespace
}  // namespace strake
