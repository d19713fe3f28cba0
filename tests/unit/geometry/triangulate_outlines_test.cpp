#include "common/geometry/plane/triangulate_outlines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <utility>

namespace strake {
namespace {

using Outlines = std::vector<std::vector<Index>>;
using Triangles = std::vector<std::array<Index, 3>>;

double area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
}

double area(const std::vector<Vec2>& points, const Outlines& outlines) {
  double sum = 0;
  for (const auto& outline : outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      sum += area(Vec2::Zero(), points[outline[i]], points[outline[(i + 1) % outline.size()]]);
    }
  }
  return sum;
}

/// How often each side is that of a triangle.
std::map<std::pair<Index, Index>, int> sides(const Triangles& triangles) {
  std::map<std::pair<Index, Index>, int> count;
  for (const auto& t : triangles) {
    for (int i = 0; i < 3; ++i) ++count[{t[i], t[(i + 1) % 3]}];
  }
  return count;
}

/// Positive triangles whose sides are those of the outlines, once, and others in both directions.
void expect_filled(const std::vector<Vec2>& points, const Outlines& outlines,
                   const Triangles& triangles) {
  double sum = 0;
  for (const auto& t : triangles) {
    const double size = area(points[t[0]], points[t[1]], points[t[2]]);
    EXPECT_GT(size, 0);
    sum += size;
  }
  EXPECT_NEAR(sum, area(points, outlines), 1e-12 * sum);
  auto count = sides(triangles);
  for (const auto& outline : outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const std::pair side(outline[i], outline[(i + 1) % outline.size()]);
      EXPECT_EQ(count[side], 1);
      count.erase(side);
    }
  }
  for (const auto& [side, times] : count) {
    if (times == 0) continue;
    EXPECT_EQ(times, 1);
    EXPECT_TRUE(count.contains({side.second, side.first})) << side.first << " " << side.second;
  }
}

std::vector<Index> range(Index first, Index count) {
  std::vector<Index> indices(count);
  std::iota(indices.begin(), indices.end(), first);
  return indices;
}

TEST(TriangulateOutlines, FillsStarsWithHoles) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> radius(0.4, 1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Vec2> points;
    const auto star = [&](Index corners, double scale, double direction) {
      const auto first = static_cast<Index>(points.size());
      for (Index i = 0; i < corners; ++i) {
        const double angle = direction * 2 * M_PI * i / corners;
        points.emplace_back(scale * radius(random) * Vec2(std::cos(angle), std::sin(angle)));
      }
      return range(first, corners);
    };
    const auto corners = static_cast<Index>(3 + random() % 40);
    const Outlines outlines = {star(9 + corners, 1, 1), star(corners, 0.3, -1)};
    const Triangles triangles = triangulate_outlines(points, outlines);
    EXPECT_EQ(triangles.size(), points.size());  // n + 2 holes - 2 (Euler)
    expect_filled(points, outlines, triangles);
  }
}

// Corners of holes and of the outline share the coordinate along which GEOS sorts what it joins.
TEST(TriangulateOutlines, FillsAroundHolesInRows) {
  const std::vector<Vec2> points = {{16, -127}, {134, 25},  {-37, 24},  {-49, -68}, {9, -98},
                                    {13, -98},  {15, -101}, {-35, -80}, {-37, -76}, {-35, -73},
                                    {-37, -66}, {-35, -63}, {-30, -63}};
  const Outlines outlines = {range(0, 4), {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
  const Triangles triangles = triangulate_outlines(points, outlines);
  EXPECT_EQ(triangles.size(), points.size() + 2 * 3 - 2);
  expect_filled(points, outlines, triangles);
}

// Of four points on a rhombus the shorter diagonal joins two; of a longer one neither is Delaunay.
TEST(TriangulateOutlines, IsDelaunay) {
  const std::vector<Vec2> points = {{0, 0}, {3, -1}, {6, 0}, {3, 1}};
  const Triangles triangles = triangulate_outlines(points, {range(0, 4)});
  ASSERT_EQ(triangles.size(), 2u);
  const auto count = sides(triangles);
  EXPECT_TRUE(count.contains({1, 3}));
  EXPECT_FALSE(count.contains({0, 2}));
}

TEST(TriangulateOutlines, MayTouchThemselves) {
  // A hole with a corner on the outer outline, and two squares with a corner in common.
  const std::vector<Vec2> points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 2},
                                    {2, 1}, {6, 4}, {6, 6}, {4, 6}};
  const Outlines hole = {{0, 4, 5, 0, 1, 2, 3}};
  const Triangles around = triangulate_outlines(points, hole);
  EXPECT_EQ(around.size(), 5u);
  expect_filled(points, hole, around);
  const Outlines pinched = {{0, 1, 2, 6, 7, 8, 2, 3}};
  const Triangles both = triangulate_outlines(points, pinched);
  EXPECT_EQ(both.size(), 4u);
  expect_filled(points, pinched, both);
}

TEST(TriangulateOutlines, RefuseWhatBoundsNoArea) {
  const std::vector<Vec2> square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_EQ(triangulate_outlines(square, {{0, 1, 2, 3}}).size(), 2u);
  EXPECT_TRUE(triangulate_outlines(square, {{0, 2, 1, 3}}).empty()) << "sides cross";
  EXPECT_TRUE(triangulate_outlines(square, {{3, 2, 1, 0}}).empty()) << "a hole in nothing";
  EXPECT_TRUE(triangulate_outlines({{0, 0}, {1, 0}, {2, 0}}, {{0, 1, 2}}).empty()) << "no area";
  EXPECT_TRUE(triangulate_outlines({{0, 0}, {1, 0}, {1, 0}, {0, 1}}, {{0, 1, 2, 3}}).empty())
      << "two points at one place";
  std::vector<Vec2> apart = square;
  for (const Vec2& p : square) apart.emplace_back(p.x() + 5, p.y());
  EXPECT_TRUE(triangulate_outlines(apart, {{0, 1, 2, 3}, {7, 6, 5, 4}}).empty())
      << "a hole outside";
}

}  // namespace
}  // namespace strake
