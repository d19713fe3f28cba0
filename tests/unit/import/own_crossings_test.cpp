#include "stages/import/own_crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::count;
using shapes::imported;

std::string warning_of_crossings(const ImportResult& result) {
  for (const std::string& warning : result.report.warnings()) {
    if (warning.find("of the mesh itself") != std::string::npos) return warning;
  }
  return "";
}

TEST(OwnCrossings, BodiesThatPassThroughEachOtherAreNamed) {
  const Vec3 shift(0.3, 0.4, 0.6);
  const PolyMesh both = support::together(shapes::cube(), shapes::cube(shift));
  const ImportResult result = imported(both);
  EXPECT_GT(count(result.report, "crossings.pairs"), 0);
  const std::string warning = warning_of_crossings(result);
  ASSERT_NE(warning, "");
  // Moved far away the numbers and the sense are the same, and the place moves along.
  const ImportResult far = imported(support::transformed(both, Mat3::Identity(), Vec3(4096, 0, 0)));
  EXPECT_EQ(count(far.report, "crossings.pairs"), count(result.report, "crossings.pairs"));
  const double x =
      std::stod(warning_of_crossings(far).substr(warning_of_crossings(far).find('(') + 1));
  EXPECT_NEAR(x, 4096.65, 0.65);
}

TEST(OwnCrossings, OneSpikeThroughAFaceIsOnePair) {
  // A triangle that stands in the middle of another one: one pair.
  const PolyMesh mesh =
      shapes::polygons({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1.5, 1, -1}, {1.2, 1.1, 1}},
                       {{0, 1, 2}, {3, 4, 5}});
  const ImportResult result = imported(mesh);
  EXPECT_EQ(count(result.report, "crossings.pairs"), 1);
  EXPECT_EQ(warning_of_crossings(result).substr(0, 6), "1 pair");
}

TEST(OwnCrossings, SheetsThatOverlapInAPlaneAreNamed) {
  const PolyMesh mesh =
      shapes::polygons({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {5, 1.5, 0}, {1.2, 5, 0}},
                       {{0, 1, 2}, {3, 4, 5}});
  EXPECT_EQ(count(imported(mesh).report, "crossings.pairs"), 1);
}

TEST(OwnCrossings, WhatOnlyTouchesIsNone) {
  // Along an edge that both have, along a part of one, in a part of a face, and not at all.
  for (const Vec3& shift : {Vec3(1, 1, 0), Vec3(1, 1, 0.5), Vec3(1, 0.5, 0.5), Vec3(3, 0, 0)}) {
    const ImportResult result = imported(support::together(shapes::cube(), shapes::cube(shift)));
    EXPECT_EQ(warning_of_crossings(result), "") << shift.transpose();
  }
  EXPECT_EQ(warning_of_crossings(imported(shapes::torus(24, 12))), "");
}

}  // namespace
}  // namespace strake
