#include "stages/import/openings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "stages/import/import.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::imported;

/// "" where nothing was opened or taken apart.
std::string warning_of(const ImportResult& result) {
  for (const std::string& warning : result.report.warnings()) {
    if (warning.starts_with("repairs ")) return warning;
  }
  return "";
}

/// The unit cube and, at its edge along x, further faces between the ends of that (0 and 1) and
/// two vertices (8 and 9) that are `width` away, where a union of solids was rounded.
PolyMesh cube_with(double width, const std::vector<std::vector<Index>>& faces) {
  PolyMesh mesh = shapes::cube();
  mesh.positions.emplace_back(1, -width, -width);
  mesh.positions.emplace_back(0, -width, -width);
  for (const std::vector<Index>& face : faces) mesh.add_face(face);
  return mesh;
}

/// Each triangle there and back: a fin that hangs on one edge.
const std::vector<std::vector<Index>> kFold = {{0, 1, 8}, {0, 8, 9}, {8, 1, 0}, {9, 8, 0}};
/// Divided along one diagonal there and along the other back: a shell without volume.
const std::vector<std::vector<Index>> kShell = {{0, 1, 8}, {0, 8, 9}, {1, 0, 9}, {1, 9, 8}};

void expect_whole_cube(const PolyMesh& mesh) {
  const ImportResult result = imported(mesh);
  const Census counts = census(result.mesh);
  EXPECT_EQ(counts.components, 1);
  EXPECT_EQ(counts.boundary_loops, 0);
  EXPECT_EQ(counts.euler_characteristic, 2);
  EXPECT_NEAR(shapes::volume(result.mesh), 1, 1e-5);
  EXPECT_EQ(warning_of(result), "");
}

TEST(Openings, SliversThatAUnionLeavesDoNotOpenASolid) {
  // One copy of a fin would make three faces at the edge, none of which goes on flat.
  expect_whole_cube(cube_with(1e-6, kFold));
  expect_whole_cube(cube_with(1e-6, kShell));
  PolyMesh turned = support::transformed(cube_with(1e-6, kFold), 50 * support::oblique_rotation(),
                                         Vec3(30, -20, 10));
  const Census counts = census(imported(turned).mesh);
  EXPECT_EQ(counts.components, 1);
  EXPECT_EQ(counts.boundary_loops, 0);
}

TEST(Openings, ShortEdgesGoWhereAUnionLeftSlivers) {
  // A vertex on the edge along x, 3e-7 of the diagonal from its end.
  PolyMesh mesh = shapes::filtered(cube_with(1e-6, {}), [](Index f) { return f != 0 && f != 2; });
  mesh.positions.emplace_back(5e-7, 0, 0);
  mesh.add_face(std::vector<Index>{0, 2, 3, 1, 10});
  mesh.add_face(std::vector<Index>{0, 10, 1, 5, 4});
  EXPECT_EQ(imported(mesh).mesh.vertex_count(), 9);
  for (std::vector<Index> moved : kFold) {
    std::replace(moved.begin(), moved.end(), 0, 10);
    mesh.add_face(moved);
  }
  EXPECT_EQ(imported(mesh).mesh.vertex_count(), 8);
  expect_whole_cube(mesh);
}

TEST(Openings, WideSheetsAndShellsStay) {
  const auto area_with = [&](const std::vector<std::vector<Index>>& faces) {
    return shapes::area(imported(cube_with(0.5, faces)).mesh);
  };
  const double sheet = std::sqrt(0.5);
  EXPECT_NEAR(area_with(kFold), 6 + sheet, 1e-12);
  EXPECT_NEAR(area_with(kShell), 6 + 2 * sheet, 1e-12);
}

TEST(Openings, NarrowPiecesOfTheirOwnStay) {
  PolyMesh mesh = shapes::cube();
  const Index first = mesh.vertex_count();
  for (const Vec3& p : {Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(3, 1e-6, 0), Vec3(2, 1e-6, 0)}) {
    mesh.positions.push_back(p);
  }
  mesh.add_face(std::vector<Index>{first, first + 1, first + 2, first + 3});
  EXPECT_EQ(census(imported(mesh).mesh).components, 2);
}

TEST(Openings, WhatRepairsOpenAndTakeApartIsSaid) {
  // Three triangles at an edge, two of them in a plane: 6 edges on the boundary, and one more
  // where the third comes off.
  const PolyMesh flaps =
      shapes::polygons({Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0)},
                       {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const std::string warning = warning_of(imported(flaps));
  EXPECT_NE(warning.find("has 7 boundary edges, and had 6"), std::string::npos) << warning;
  EXPECT_NE(warning.find("has 2 pieces, and had 1"), std::string::npos) << warning;
  EXPECT_NE(warning.find("boolean union"), std::string::npos) << warning;
}

TEST(Openings, NothingIsSaidWhereNothingOpens) {
  EXPECT_EQ(warning_of(imported(shapes::cube())), "");
  EXPECT_EQ(warning_of(imported(shapes::unwelded(shapes::cube()))), "");
  EXPECT_EQ(warning_of(imported(shapes::grid(3, 3, [](double, double) { return 0.0; }))), "");
  const PolyMesh torus = shapes::torus(12, 8);
  EXPECT_EQ(warning_of(imported(shapes::turned(torus, [](Index f) { return f % 7 == 3; }))), "");
}

}  // namespace
}  // namespace strake
