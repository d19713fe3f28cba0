#include "stages/refine/thin_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;
using Triangles = std::vector<std::array<Index, 3>>;

/// Positions and triangles of a grid over the unit square.
Case sheet(double bump) {
  return grid(8, 1, [&](double x, double y) { return x == 0.5 && y == 0.5 ? bump : 0.0; });
}

TEST(ThinOut, LeavesOnlyWhatTheDistanceNeeds) {
  for (const auto& [bump, is_kept] : {std::pair{0.2, true}, {0.02, false}, {0.0, false}}) {
    const TriMesh mesh = sheet(bump).mesh;
    const std::vector<double> distance(mesh.positions.size(), 0.05);
    const Triangles left = thin_out(mesh.positions, mesh.faces, distance);
    std::set<Index> vertices;
    for (const auto& t : left) vertices.insert(t.begin(), t.end());
    const Index middle = 4 * 9 + 4;
    EXPECT_EQ(vertices.contains(middle), is_kept);
    EXPECT_LT(vertices.size(), 32u + 20u);  // of 81, the 32 around stay
    for (Index v = 0; v < 81; ++v) {
      const bool is_around = v % 9 == 0 || v % 9 == 8 || v / 9 == 0 || v / 9 == 8;
      if (is_around) {
        EXPECT_TRUE(vertices.contains(v)) << v;
      }
    }
  }
}

/// OpenMesh would tell the process's error stream.
TEST(ThinOut, LeavesWhatIsNoManifoldInSilence) {
  const std::vector<Vec3> positions = {Vec3(0, 0, 0),  Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0),
                                       Vec3(0, -1, 0), Vec3(1, 1, 1), Vec3(-1, 1, 1)};
  const Triangles fan_and_more = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {0, 5, 6}};
  testing::internal::CaptureStderr();
  const Triangles left =
      thin_out(positions, fan_and_more, std::vector<double>(positions.size(), 0.1));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(left, fan_and_more);
}

TEST(ThinOut, KeepsWhatStays) {
  const TriMesh mesh = sheet(0).mesh;
  std::vector<double> distance(mesh.positions.size(), 0.05);
  const Index kept = 2 * 9 + 3;
  distance[kept] = 0;
  const Triangles left = thin_out(mesh.positions, mesh.faces, distance);
  EXPECT_TRUE(std::ranges::any_of(
      left, [&](const auto& t) { return std::ranges::find(t, kept) != t.end(); }));
}

TEST(ThinOut, TakesTheDistanceOfThePlace) {
  // Waves across the sheet, which need their vertices where the distance is below their height.
  const TriMesh mesh = grid(16, 1, [](double x, double) { return 0.01 * std::sin(40 * x); }).mesh;
  const auto is_below = [&](Index v) { return mesh.positions[v].y() + mesh.origin.y() < 0.5; };
  std::vector<double> distance;
  for (Index v = 0; v < mesh.vertex_count(); ++v) distance.push_back(is_below(v) ? 0.03 : 0.001);
  std::set<Index> left;
  for (const auto& t : thin_out(mesh.positions, mesh.faces, distance))
    left.insert(t.begin(), t.end());
  const auto below = std::ranges::count_if(left, is_below);
  EXPECT_LT(2 * below, std::ssize(left) - below);
}

TEST(ThinOut, JoinsNoTwoVerticesOfTheOutline) {
  // A strip with a row of vertices along its middle: one of these, merged into one of the outline,
  // would join that to those across.
  constexpr Index kLength = 8;
  const auto below = [](Index i) { return i; };
  const auto above = [](Index i) { return kLength + 1 + i; };
  const auto middle = [](Index i) { return 2 * (kLength + 1) + i; };
  std::vector<Vec3> positions;
  for (const double y : {0.0, 2.0}) {
    for (Index i = 0; i <= kLength; ++i) positions.emplace_back(i, y, 0);
  }
  for (Index i = 0; i < kLength; ++i) positions.emplace_back(i + 0.5, 1, 0);
  Triangles strip = {{below(0), middle(0), above(0)},
                     {below(kLength), above(kLength), middle(kLength - 1)}};
  for (Index i = 0; i < kLength; ++i) {
    strip.push_back({below(i), below(i + 1), middle(i)});
    strip.push_back({above(i + 1), above(i), middle(i)});
    if (i + 1 == kLength) break;
    strip.push_back({below(i + 1), middle(i + 1), middle(i)});
    strip.push_back({above(i + 1), middle(i), middle(i + 1)});
  }
  const auto is_chord = [&](Index a, Index b) {
    const bool at_ends = positions[a].x() == positions[b].x() &&
                         (positions[a].x() == 0 || positions[a].x() == kLength);
    return std::abs(positions[a].y() - positions[b].y()) == 2 && !at_ends;
  };
  const std::vector<double> distance(positions.size(), 0.1);
  const Triangles left = thin_out(positions, strip, distance);
  EXPECT_LT(left.size(), strip.size());
  for (const auto& [a, b, c] : left) {
    EXPECT_FALSE(is_chord(a, b) || is_chord(b, c) || is_chord(c, a)) << a << " " << b << " " << c;
  }
}

TEST(ThinOut, TurnsSliversIntoTheTriangleBeside) {
  // On a ridge from 0 to 1, in the middle, lies vertex 3, all but.
  const std::vector<Vec3> around = {{0, 0, 0.2}, {1, 0, 0.2}, {0.5, 1, 0.2}, {0.5, -1e-6, 0.2},
                                    {-1, -1, 0}, {2, -1, 0},  {0.5, 2, 0}};
  const Triangles disk = {{0, 1, 2}, {1, 0, 3}, {0, 4, 3}, {4, 5, 3}, {5, 1, 3},
                          {5, 6, 1}, {6, 2, 1}, {6, 0, 2}, {6, 4, 0}};
  const auto is_in = [](const Triangles& triangles, const std::set<Index>& corners) {
    return std::ranges::any_of(
        triangles, [&](const auto& t) { return std::set<Index>(t.begin(), t.end()) == corners; });
  };
  const auto but = [](std::initializer_list<std::size_t> stay) {
    std::vector<double> distance(7, 1e-3);
    for (const std::size_t v : stay) distance[v] = 0;
    return distance;
  };
  const Triangles turned = thin_out(around, disk, but({3}));
  EXPECT_EQ(turned.size(), disk.size());
  EXPECT_TRUE(is_in(turned, {0, 3, 2}) && is_in(turned, {1, 2, 3}));
  // An edge between vertices that stay may be part of a line.
  EXPECT_TRUE(is_in(thin_out(around, disk, but({0, 1, 3})), {0, 1, 3}));
  // Of these two triangles it would join two vertices of the outline.
  const Triangles alone = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(thin_out({around.begin(), around.begin() + 4}, alone, {1e-3, 1e-3, 1e-3, 1e-3}), alone);
}

}  // namespace
}  // namespace strake
