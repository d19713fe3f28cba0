#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "common/geometry/patch_fill/disk_outline.h"
#include "common/geometry/patch_fill/drop_unused_vertices.h"
#include "common/geometry/patch_fill/fill_band.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using Faces = std::vector<std::vector<Index>>;

/// Squares of a grid of n x n, by their numbers.
Faces squares(Index n, const std::vector<Index>& numbers) {
  Faces faces;
  for (const Index f : numbers) {
    const Index a = f / n * (n + 1) + f % n;
    faces.push_back({a, a + 1, a + n + 2, a + n + 1});
  }
  return faces;
}

TEST(DiskOutline, GoesAroundADisk) {
  const DiskOutline outline = disk_outline(squares(3, {0, 1, 3}));
  EXPECT_EQ(outline.ring, (std::vector<Index>{0, 1, 2, 6, 5, 9, 8, 4}));
  EXPECT_TRUE(outline.pinched.empty());
}

TEST(DiskOutline, IsNoneOfARingOrOfTwoDisks) {
  EXPECT_TRUE(disk_outline(squares(3, {0, 1, 2, 3, 5, 6, 7, 8})).ring.empty());
  EXPECT_TRUE(disk_outline(squares(4, {0, 3})).ring.empty());
}

TEST(DiskOutline, SaysWhereItTouchesItself) {
  const DiskOutline outline = disk_outline(squares(2, {0, 3}));
  EXPECT_TRUE(outline.ring.empty());
  EXPECT_EQ(outline.pinched, std::vector<Index>{4});
}

TEST(DiskOutline, FollowsWalls) {
  const auto is_wall = [](Index a, Index b) { return std::set{a, b} == std::set<Index>{1, 4}; };
  // The wall in the middle of two squares makes two disks of them.
  EXPECT_TRUE(disk_outline(squares(2, {0, 1}), is_wall).ring.empty());
  EXPECT_EQ(disk_outline(squares(2, {0}), is_wall).ring.size(), 4u);
}

/// Corners of a regular polygon, turned by an angle.
std::vector<Vec3> polygon(std::size_t n, double radius, double turned) {
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < n; ++i) {
    const double at = turned + 2 * std::numbers::pi * double(i) / double(n);
    corners.emplace_back(radius * std::cos(at), radius * std::sin(at), 0);
  }
  return corners;
}

double area(std::size_t n, double radius) {
  return double(n) / 2 * radius * radius * std::sin(2 * std::numbers::pi / double(n));
}

class FillBand : public testing::TestWithParam<std::pair<std::size_t, std::size_t>> {};

TEST_P(FillBand, CoversTheBandOnce) {
  const auto [n, m] = GetParam();
  for (const double turned : {0.0, 1.0, 4.5}) {
    std::vector<Vec3> corners = polygon(n, 2, 0.3);
    const std::vector<Vec3> inner = polygon(m, 1.2, turned);
    corners.insert(corners.end(), inner.begin(), inner.end());
    const auto triangles = fill_band(
        n, m, [&](std::size_t i, std::size_t j) { return (corners[i] - inner[j]).squaredNorm(); });
    ASSERT_EQ(triangles.size(), n + m);
    double sum = 0;
    std::set<std::array<Index, 2>> sides;
    for (const auto& t : triangles) {
      sum += (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).norm() / 2;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(sides.insert({t[i], t[(i + 1) % 3]}).second);
      }
    }
    EXPECT_NEAR(sum, area(n, 2) - area(m, 1.2), 1e-9);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_TRUE(sides.contains({Index(i), Index((i + 1) % n)}));
    }
    for (std::size_t j = 0; j < m; ++j) {
      EXPECT_TRUE(sides.contains({Index(n + (j + 1) % m), Index(n + j)}));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Polygons, FillBand,
                         testing::Values(std::pair{12, 12}, std::pair{12, 40}, std::pair{30, 9}));

TEST(FillBandBetween, TakesTheEdgesThatCostLeast) {
  // An edge that is free is taken, though it is long.
  const std::vector<Vec3> outer = polygon(12, 2, 0);
  const std::vector<Vec3> inner = polygon(12, 1.9, 0);
  const auto triangles = fill_band(12, 12, [&](std::size_t i, std::size_t j) {
    return i == 3 && j == 4 ? 0.0 : (outer[i] - inner[j]).squaredNorm();
  });
  bool is_taken = false;
  for (const auto& t : triangles) {
    const std::set<Index> corners(t.begin(), t.end());
    is_taken = is_taken || (corners.contains(3) && corners.contains(12 + 4));
  }
  EXPECT_TRUE(is_taken);
}

TEST(DropUnusedVertices, KeepsTheOthersAsTheyWere) {
  QuadMesh quads = support::grid(2, 2, [](double, double) { return 0.0; }).quads;
  const QuadMesh before = quads;
  quads.mesh.corners.erase(quads.mesh.corners.begin(), quads.mesh.corners.begin() + 4);
  quads.mesh.offsets = {0, 4, 8, 12};  // without the first square: vertex 0 goes
  drop_unused_vertices(quads);
  ASSERT_EQ(quads.mesh.vertex_count(), 8);
  ASSERT_EQ(quads.provenance.face.size(), 8u);
  for (Index v = 0; v < 8; ++v) {
    EXPECT_EQ(quads.mesh.positions[v], before.mesh.positions[v + 1]);
    EXPECT_EQ(quads.provenance.face[v], before.provenance.face[v + 1]);
    EXPECT_EQ(quads.provenance.barycentric[v], before.provenance.barycentric[v + 1]);
    EXPECT_EQ(quads.provenance.lines[v], before.provenance.lines[v + 1]);
  }
  for (std::size_t c = 0; c < quads.mesh.corners.size(); ++c) {
    EXPECT_EQ(quads.mesh.corners[c] + 1, before.mesh.corners[c + 4]);
  }
}

}  // namespace
}  // namespace strake
