#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/core/text.h"
#include "common/geometry/topology/topology.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::count;

ImportOptions filling(double percents) {
  ImportOptions options = shapes::undivided();
  options.fill_holes = percent(percents);
  return options;
}

Vec3 middle_of(const PolyMesh& mesh, Index face) {
  Vec3 sum = Vec3::Zero();
  for (const Index v : mesh.face(face)) sum += mesh.positions[v];
  return sum / static_cast<double>(mesh.face(face).size());
}

/// Without the faces whose middle is nearer than `radius` to a place.
PolyMesh with_hole(const PolyMesh& mesh, const Vec3& place, double radius) {
  return shapes::filtered(mesh,
                          [&](Index f) { return (middle_of(mesh, f) - place).norm() >= radius; });
}

/// How far a point is from the torus of `shapes::torus`.
double off_torus(const Vec3& p, double tube = 0.4) {
  return std::abs(std::hypot(std::hypot(p.x(), p.y()) - 1, p.z()) - tube);
}

double farthest_off_torus(const TriMesh& mesh) {
  double farthest = 0;
  for (const Vec3& p : mesh.positions) farthest = std::max(farthest, off_torus(p));
  return farthest;
}

bool warns_of(const ImportResult& result, const std::string& what) {
  return std::ranges::any_of(result.report.warnings(), [&](const std::string& warning) {
    return warning.find(what) != std::string::npos;
  });
}

TEST(FillHoles, GoesOnFromACurvedSurface) {
  // Across the outside of the tube, where both curvatures have the same sign, and the inside.
  for (const double side : {1.4, 0.6}) {
    const PolyMesh torus = shapes::torus(96, 48);
    const PolyMesh open = with_hole(torus, Vec3(side, 0, 0), 0.2);
    const ImportResult result = shapes::imported(open, filling(20));
    EXPECT_EQ(count(result.report, "holes.filled"), 1);
    EXPECT_EQ(count(result.report, "holes.left"), 0);
    EXPECT_EQ(count(result.report, "census.boundary_loops"), 0);
    EXPECT_EQ(count(result.report, "census.euler_characteristic"), 0);
    // A lid without any bend would be 0.05 off in its middle.
    EXPECT_LT(farthest_off_torus(result.mesh), 0.012);
    const double expected = shapes::volume(shapes::imported(torus).mesh);
    EXPECT_NEAR(shapes::volume(result.mesh), expected, 1e-3 * expected);
    EXPECT_TRUE(warns_of(result, "holes filled"));
  }
}

TEST(FillHoles, OfFlatsAreFlatAndFineAsTheyAre) {
  const PolyMesh grid = shapes::grid(20, 20, [](double, double) { return 0.0; });
  const ImportResult result =
      shapes::imported(with_hole(grid, Vec3(0.5, 0.5, 0), 0.2), filling(50));
  EXPECT_EQ(count(result.report, "holes.filled"), 1);
  EXPECT_EQ(count(result.report, "census.boundary_loops"), 1);
  EXPECT_NEAR(shapes::area(result.mesh), 1, 1e-9);
  double longest = 0;
  for (const auto& [a, b, c] : result.mesh.faces) {
    EXPECT_NEAR(result.mesh.positions[a].z(), 0, 1e-12);
    longest = std::max(longest, (result.mesh.positions[a] - result.mesh.positions[b]).norm());
  }
  EXPECT_LT(longest, 0.12);  // of the hole, too: edges of the grid are 0.05 long
}

TEST(FillHoles, ThatAreWiderStay) {
  const PolyMesh open =
      with_hole(with_hole(shapes::torus(96, 48), Vec3(1.4, 0, 0), 0.2), Vec3(-1.4, 0, 0), 0.08);
  const ImportResult result = shapes::imported(open, filling(8));
  EXPECT_EQ(count(result.report, "holes.filled"), 1);
  EXPECT_EQ(count(result.report, "census.boundary_loops"), 1);
  EXPECT_EQ(count(shapes::imported(open).report, "census.boundary_loops"), 2);
}

TEST(FillHoles, WhereAPieceEndsStaysOpen) {
  // A tube has two ends, a patch one outline, and neither is a hole.
  const PolyMesh tube = shapes::filtered(shapes::torus(48, 24), [](Index f) { return f % 48 < 4; });
  EXPECT_EQ(count(shapes::imported(tube, filling(100)).report, "holes.filled"), 0);
  const PolyMesh patch = shapes::grid(4, 4, [](double, double) { return 0.0; });
  EXPECT_EQ(count(shapes::imported(patch, filling(100)).report, "holes.filled"), 0);
}

TEST(FillHoles, ThatMeetInAVertexAreFilledEach) {
  PolyMesh grid = shapes::grid(12, 12, [](double x, double y) { return 0.1 * x * y; });
  const PolyMesh open =
      shapes::filtered(grid, [](Index f) { return f != 12 * 5 + 5 && f != 12 * 6 + 6; });
  const ImportResult result = shapes::imported(open, filling(30));
  EXPECT_EQ(count(result.report, "holes.filled"), 2);
  EXPECT_EQ(count(result.report, "holes.left"), 0);
  EXPECT_EQ(count(result.report, "census.boundary_loops"), 1);
  EXPECT_EQ(count(result.report, "census.vertices"), 13 * 13);
  EXPECT_EQ(count(result.report, "census.faces"), 2 * 12 * 12);
}

TEST(FillHoles, WhatHangsIntoOneByAVertexStays) {
  PolyMesh open = shapes::filtered(shapes::grid(12, 12, [](double, double) { return 0.0; }),
                                   [](Index f) { return f != 12 * 5 + 5; });
  const Index corner = 13 * 5 + 5;
  open.positions.emplace_back(5.5 / 12, 5.2 / 12, 0.01);
  open.positions.emplace_back(5.2 / 12, 5.5 / 12, 0.01);
  open.add_face(std::array<Index, 3>{corner, 13 * 13, 13 * 13 + 1});
  const ImportResult result = shapes::imported(open, filling(30));
  EXPECT_EQ(count(result.report, "holes.filled"), 1);
  EXPECT_EQ(count(result.report, "census.boundary_loops"), 2);  // of the grid, and of the triangle
  EXPECT_EQ(count(result.report, "census.faces"), 2 * 12 * 12 + 1);
}

TEST(FillHoles, OfManyCornersAreParted) {
  const PolyMesh torus = shapes::torus(600, 300);
  const ImportResult result =
      shapes::imported(with_hole(torus, Vec3(1.4, 0, 0), 0.25), filling(25));
  EXPECT_EQ(count(result.report, "holes.filled"), 1);
  EXPECT_EQ(count(result.report, "census.boundary_loops"), 0);
  EXPECT_LT(farthest_off_torus(result.mesh), 0.015);
}

TEST(FillHoles, HaveColoursLabelsAndTextureFromAround) {
  PolyMesh torus = shapes::torus(96, 48);
  torus.attributes.colour.assign(torus.positions.size(), Colour{0.25, 0.5, 0.75, 1});
  PolyMesh open = with_hole(torus, Vec3(1.4, 0, 0), 0.2);
  open.attributes.colour = torus.attributes.colour;
  open.attributes.texture.assign(open.corners.size(), TexturePoint{0.25, 0.75});
  open.attributes.labels.push_back(
      {"part", std::vector<Index>(static_cast<std::size_t>(open.face_count()), 1), {"a", "b"}});
  const ImportResult result = shapes::imported(open, filling(20));
  const Attributes& attributes = result.mesh.attributes;
  ASSERT_EQ(count(result.report, "holes.filled"), 1);
  for (const Colour& colour : attributes.colour) {
    EXPECT_NEAR(colour[0], 0.25, 1e-12);
    EXPECT_NEAR(colour[2], 0.75, 1e-12);
  }
  ASSERT_EQ(attributes.texture.size(), 3 * result.mesh.faces.size());
  for (const TexturePoint& point : attributes.texture) EXPECT_NEAR(point[1], 0.75, 1e-12);
  ASSERT_EQ(attributes.labels.size(), 1U);
  EXPECT_EQ(std::ranges::count(attributes.labels[0].of_face, 1),
            static_cast<std::ptrdiff_t>(result.mesh.faces.size()));
}

TEST(FillHoles, ManySmallOnesAreNamed) {
  const PolyMesh torus = shapes::torus(400, 200);
  const auto without = [&](Index every) {
    return shapes::filtered(torus, [&](Index f) { return f % every != every / 2; });
  };
  EXPECT_TRUE(warns_of(shapes::imported(without(4001)), "--fill-holes"));
  EXPECT_FALSE(warns_of(shapes::imported(without(20001)), "--fill-holes"));
  EXPECT_FALSE(warns_of(shapes::imported(without(4001), filling(3)), "--fill-holes"));
}

}  // namespace
}  // namespace strake
