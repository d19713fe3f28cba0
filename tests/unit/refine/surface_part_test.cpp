#include "stages/refine/surface_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

#include "tests/support/result_cases.h"
#include "tests/unit/refine/inlay_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;

TEST(SurfacePart, IsTheSurfaceWithShortEdgesInTheBox) {
  const Case c = grid(4, 4, terrain);
  const Eigen::AlignedBox3d box(Vec3(0.3, 0.3, -1), Vec3(0.7, 0.7, 1));
  const SurfacePart part = surface_part(c.mesh, {10}, box, 0.05, 10000);
  ASSERT_GT(part.faces.size(), 100u);
  double of_parents = 0;
  for (const Index f : std::set<Index>(part.parent.begin(), part.parent.end())) {
    of_parents += area_vector(c.mesh.positions, c.mesh.faces[f]).norm();
  }
  EXPECT_NEAR(area(part.positions, part.faces), of_parents, 1e-12);
  for (std::size_t v = 0; v < part.points.size(); ++v) {
    EXPECT_LT((place_of(c.mesh, part.points[v]) - part.positions[v]).norm(), 1e-12);
  }
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& a = part.positions[part.faces[f][i]];
      const Vec3& b = part.positions[part.faces[f][(i + 1) % 3]];
      if (box.contains(a) && box.contains(b)) {
        EXPECT_LE((b - a).norm(), 0.05);
      }
      const Index g = part.neighbours[f][i];
      EXPECT_FALSE(g != kNone &&
                   part.boundary.contains({part.faces[f][i], part.faces[f][(i + 1) % 3]}));
      if (g == kNone) continue;
      EXPECT_EQ(std::ranges::count(part.neighbours[g], static_cast<Index>(f)), 1);
      EXPECT_EQ(std::ranges::count(part.faces[g], part.faces[f][i]), 1);
      EXPECT_EQ(std::ranges::count(part.faces[g], part.faces[f][(i + 1) % 3]), 1);
    }
  }
}

TEST(SurfacePart, KnowsTheBoundaryOfTheSurface) {
  const Case c = grid(8, 4, [](double, double) { return 0.0; });
  const Eigen::AlignedBox3d box(Vec3(0.01, 0.3, -1), Vec3(0.6, 0.7, 1));
  const SurfacePart part = surface_part(c.mesh, {40}, box, 0.05, 10000);
  double length = 0;
  for (const auto& [a, b] : part.boundary) {
    EXPECT_EQ(part.positions[a].x() + c.mesh.origin.x(), 0);
    EXPECT_EQ(part.positions[b].x() + c.mesh.origin.x(), 0);
    EXPECT_LE((part.positions[b] - part.positions[a]).norm(), 0.125);
    length += (part.positions[b] - part.positions[a]).norm();
  }
  EXPECT_NEAR(length, 0.5, 1e-12);  // four sides of squares, from 0.25 to 0.75
}

TEST(SurfacePart, IsEmptyWhereItWouldHaveTooManyFaces) {
  const Case c = grid(4, 4, terrain);
  const Eigen::AlignedBox3d box(Vec3(0, 0, -1), Vec3(1, 1, 1));
  EXPECT_TRUE(surface_part(c.mesh, {0}, box, 0.01, 1000).faces.empty());
  EXPECT_TRUE(surface_part(c.mesh, {0}, box, 10, 31).faces.empty());  // of 32, none divided
  EXPECT_EQ(surface_part(c.mesh, {0}, box, 10, 32).faces.size(), 32u);
}

}  // namespace
}  // namespace strake
