#include "common/geometry/patch_fill/patch_outline.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "common/core/error.h"
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

TEST(PatchOutline, GoesAroundADisk) {
  const PatchOutline outline = patch_outline(squares(3, {0, 1, 3}));
  ASSERT_TRUE(outline.is_disk());
  EXPECT_EQ(outline.paths.front().vertices, (std::vector<Index>{0, 1, 2, 6, 5, 9, 8, 4}));
  EXPECT_TRUE(outline.pinched.empty());
}

TEST(PatchOutline, TellsRingsAndTwoDisksFromADisk) {
  const PatchOutline ring = patch_outline(squares(3, {0, 1, 2, 3, 5, 6, 7, 8}));
  const PatchOutline disks = patch_outline(squares(4, {0, 3}));
  const PatchOutline disk = patch_outline(squares(4, {0, 1}));
  EXPECT_FALSE(ring.is_disk());
  EXPECT_FALSE(disks.is_disk());
  EXPECT_EQ(ring.euler, 0);
  EXPECT_EQ(ring.loops, 2);
  const std::array all = {ring, disks, disk};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j) EXPECT_EQ(all[i].is_like(all[j]), i == j);
  }
  EXPECT_TRUE(ring.is_like(patch_outline(squares(4, {0, 1, 2, 4, 6, 8, 9, 10}))));
}

TEST(PatchOutline, SaysWhereItTouchesItself) {
  const PatchOutline outline = patch_outline(squares(2, {0, 3}));
  EXPECT_FALSE(outline.is_disk());
  EXPECT_EQ(outline.pinched, std::vector<Index>{4});
}

TEST(PatchOutline, FollowsWalls) {
  const auto is_wall = [](Index a, Index b) { return std::set{a, b} == std::set<Index>{1, 4}; };
  // The wall in the middle of two squares makes two disks of them.
  EXPECT_FALSE(patch_outline(squares(2, {0, 1}), is_wall).is_disk());
  EXPECT_EQ(patch_outline(squares(2, {0}), is_wall).paths.front().vertices.size(), 4u);
}

TEST(PatchOutline, LeavesTheBoundaryOut) {
  // Of a grid of 3 x 3 squares, vertices 0 to 15, the outside is the boundary.
  const auto is_outside = [](Index a, Index b) {
    const auto on = [](Index v) { return std::array{v < 4, v >= 12, v % 4 == 0, v % 4 == 3}; };
    for (std::size_t side = 0; side < 4; ++side) {
      if (on(a)[side] && on(b)[side]) return true;
    }
    return false;
  };
  const PatchOutline corner = patch_outline(squares(3, {0}), {}, is_outside);
  ASSERT_EQ(corner.paths.size(), 1u);
  EXPECT_FALSE(corner.paths.front().is_closed);
  EXPECT_EQ(corner.paths.front().vertices, (std::vector<Index>{1, 5, 4}));
  EXPECT_FALSE(corner.is_disk());
  const PatchOutline row = patch_outline(squares(3, {3, 4, 5}), {}, is_outside);
  ASSERT_EQ(row.paths.size(), 2u);
  std::set<std::vector<Index>> paths;
  for (const PatchOutline::Path& path : row.paths) paths.insert(path.vertices);
  EXPECT_EQ(paths, (std::set<std::vector<Index>>{{4, 5, 6, 7}, {11, 10, 9, 8}}));
  EXPECT_FALSE(corner.is_like(row));
  EXPECT_TRUE(corner.is_like(patch_outline(squares(3, {7, 8}), {}, is_outside)));
  EXPECT_TRUE(patch_outline(squares(3, {4}), {}, is_outside).is_disk());
  const PatchOutline around = patch_outline(squares(3, {0, 1, 2, 3, 5, 6, 7, 8}), {}, is_outside);
  EXPECT_EQ(around.boundary_loops, 1);
  ASSERT_EQ(around.paths.size(), 1u);
  EXPECT_TRUE(around.paths.front().is_closed);
  EXPECT_EQ(around.paths.front().vertices.size(), 4u);
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

TEST(FillBandBetween, AsksForNoCostThatCannotMatter) {
  const std::vector<Vec3> outer = polygon(60, 2, 0.3);
  const std::vector<Vec3> inner = polygon(45, 1.7, 2.1);
  const auto square = [&](std::size_t i, std::size_t j) {
    return (outer[i] - inner[j]).squaredNorm();
  };
  std::set<std::array<std::size_t, 2>> asked;
  const auto cost = [&](std::size_t i, std::size_t j) {
    asked.insert({i, j});
    return square(i, j) * (1 + double((7 * i + 5 * j) % 11));
  };
  const auto triangles = fill_band(60, 45, cost);
  EXPECT_EQ(asked.size(), 60u * 45u);
  const auto path = fill_strip(60, 45, cost);
  asked.clear();
  EXPECT_EQ(fill_band(60, 45, cost, square), triangles);
  EXPECT_LT(asked.size(), 60u * 45u / 2);
  EXPECT_EQ(fill_strip(60, 45, cost, square), path);
}

TEST(FillStrip, CoversWhatIsBetweenTwoPathsOnce) {
  const auto outer = [](std::size_t i) { return Vec3(double(i), 0, 0); };
  const auto inner = [](std::size_t j) { return Vec3(0.5 * double(j), 1, 0); };
  const auto triangles = fill_strip(
      5, 9, [&](std::size_t i, std::size_t j) { return (outer(i) - inner(j)).squaredNorm(); });
  ASSERT_EQ(triangles.size(), 12u);
  double sum = 0;
  std::set<std::array<Index, 2>> sides;
  const auto place = [&](Index v) {
    return v < 5 ? outer(std::size_t(v)) : inner(std::size_t(v) - 5);
  };
  for (const auto& t : triangles) {
    sum += (place(t[1]) - place(t[0])).cross(place(t[2]) - place(t[0])).z() / 2;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(sides.insert({t[i], t[(i + 1) % 3]}).second);
  }
  EXPECT_NEAR(sum, 4, 1e-12);
  EXPECT_TRUE(sides.contains({5, 0}));   // from start to start, ...
  EXPECT_TRUE(sides.contains({4, 13}));  // ... and from end to end
  EXPECT_EQ(fill_strip(2, 1, [](std::size_t, std::size_t) { return 1.0; }).size(), 1u);
  EXPECT_THROW(fill_strip(0, 3, [](std::size_t, std::size_t) { return 1.0; }), PreconditionError);
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
