#include "stages/evaluate/own_crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/mesh_support.h"
#include "tests/unit/evaluate/evaluated.h"
#include "tests/unit/evaluate/shapes.h"

namespace strake {
namespace {

using evaluation::find_own_crossings;
using evaluation::OwnCrossings;

/// The cube [0, 1]^3 with another one, moved by `shift`.
PolyMesh two_cubes(const Vec3& shift) {
  const auto at = [](const Vec3& corner) {
    return shapes::moved(shapes::cube(1, 0.5),
                         [&](const Vec3& p) -> Vec3 { return p + Vec3::Constant(0.5) + corner; });
  };
  return support::together(at(Vec3::Zero()), at(shift));
}

TriMesh two_triangles(const std::vector<Vec3>& corners) {
  PolyMesh mesh;
  mesh.positions = corners;
  mesh.add_face(std::vector<Index>{0, 1, 2});
  mesh.add_face(std::vector<Index>{3, 4, 5});
  return shapes::reference(mesh);
}

OwnCrossings crossings_of(const PolyMesh& mesh) {
  return find_own_crossings(shapes::reference(mesh));
}

std::string crossing_warning(const Report& report) {
  for (const std::string& warning : report.warnings()) {
    if (warning.find("the input itself has") != std::string::npos) return warning;
  }
  return "";
}

TEST(OwnCrossings, ThePlaceIsWhereTheyCross) {
  // The cubes' surfaces cross along edges of the box that they have in common.
  const OwnCrossings own = crossings_of(two_cubes(Vec3(0.3, 0.4, 0.6)));
  EXPECT_GT(own.pairs, 0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GE(own.place[i], Vec3(0.3, 0.4, 0.6)[i]);
    EXPECT_LE(own.place[i], 1);
  }
}

TEST(OwnCrossings, OneSpikeThroughAFaceIsOnePair) {
  // A triangle that stands in the middle of another one.
  const TriMesh mesh =
      two_triangles({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1.5, 1, -1}, {1.2, 1.1, 1}});
  EXPECT_EQ(find_own_crossings(mesh).pairs, 1);
}

TEST(OwnCrossings, SheetsThatOverlapInAPlaneCross) {
  const TriMesh mesh =
      two_triangles({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {5, 1.5, 0}, {1.2, 5, 0}});
  EXPECT_EQ(find_own_crossings(mesh).pairs, 1);
}

TEST(OwnCrossings, WhatOnlyTouchesIsNone) {
  // Along an edge that both have, along a part of one, in a part of a face, and not at all.
  for (const Vec3& shift : {Vec3(1, 1, 0), Vec3(1, 1, 0.5), Vec3(1, 0.5, 0.5), Vec3(3, 0, 0)}) {
    EXPECT_EQ(crossings_of(two_cubes(shift)).pairs, 0) << shift.transpose();
  }
  EXPECT_EQ(crossings_of(shapes::torus(24, 12, 2, 1)).pairs, 0);
}

/// The figure counts all that meet: how many only touch is said with it, and warnings are of
/// others.
TEST(OwnCrossings, TouchingPairsOfTheResultAreCounted) {
  const PolyMesh touching = two_cubes(Vec3(1, 0.5, 0.5));
  const Report beside = evaluated(shapes::reference(touching), touching);
  EXPECT_GT(number(beside, "shape.self_intersecting_pairs"), 0);
  EXPECT_EQ(number(beside, "shape.touching_pairs"),
            number(beside, "shape.self_intersecting_pairs"));
  EXPECT_EQ(crossing_warning(beside), "");
  const PolyMesh both = two_cubes(Vec3(0.3, 0.4, 0.6));
  EXPECT_EQ(number(evaluated(shapes::reference(both), both), "shape.touching_pairs"), 0);
}

/// Else a figure that is not 0 would stand without a word.
TEST(OwnCrossings, OfPartsThatTouchInTheInputAreExplained) {
  const TriMesh reference = shapes::reference(two_cubes(Vec3(1, 0.5, 0.5)));
  const Report report = evaluated(reference, two_cubes(Vec3(0.98, 0.5, 0.5)));
  EXPECT_TRUE(std::ranges::any_of(report.warnings(), [](const std::string& warning) {
    return warning.find("only touch") != std::string::npos;
  }));
}

/// Solids can be united; sheets, as scans of one thing from several sides are, have no inside.
TEST(OwnCrossings, OfOpenSheetsAreNotToBeUnited) {
  PolyMesh sheets;
  sheets.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1.5, 1, -1}, {1.2, 1.1, 1}};
  sheets.add_face(std::array<Index, 3>{0, 1, 2});
  sheets.add_face(std::array<Index, 3>{3, 4, 5});
  const std::string warning = crossing_warning(evaluated(shapes::reference(sheets), sheets));
  EXPECT_NE(warning.find("make one surface"), std::string::npos) << warning;
  EXPECT_EQ(warning.find("unite"), std::string::npos) << warning;
}

/// Parts can be united, a part that crosses itself cannot.
TEST(OwnCrossings, AreToldApartFromPartsInEachOther) {
  const PolyMesh parts = two_cubes(Vec3(0.3, 0.4, 0.6));
  EXPECT_TRUE(crossings_of(parts).between_parts);
  EXPECT_NE(crossing_warning(evaluated(shapes::reference(parts), parts)).find("unite the parts"),
            std::string::npos);
  // A strip that comes back from below through the triangle where it begins.
  PolyMesh strip;
  strip.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1.5, 1, -1}, {1.2, 1.1, 1}};
  for (const auto& face :
       std::vector<std::array<Index, 3>>{{0, 1, 2}, {1, 0, 3}, {1, 3, 4}, {4, 3, 5}}) {
    strip.add_face(face);
  }
  const OwnCrossings own = crossings_of(strip);
  EXPECT_EQ(own.pairs, 1);
  EXPECT_FALSE(own.between_parts);
  const std::string warning = crossing_warning(evaluated(shapes::reference(strip), strip));
  EXPECT_NE(warning.find("repair the model"), std::string::npos);
  EXPECT_EQ(warning.find("unite"), std::string::npos);
}

TEST(OwnCrossings, AreTheSameFarAway) {
  const PolyMesh both = two_cubes(Vec3(0.3, 0.4, 0.6));
  const PolyMesh far = support::transformed(both, Mat3::Identity(), Vec3(4096, 0, 0));
  TriMesh reference = shapes::reference(both);
  reference.origin = Vec3(4096, 0, 0);
  const std::string here = crossing_warning(evaluated(shapes::reference(both), both));
  const std::string there = crossing_warning(evaluated(reference, far));
  ASSERT_NE(here, "");
  EXPECT_EQ(there.substr(0, there.find('(')), here.substr(0, here.find('(')));
  EXPECT_NEAR(std::stod(there.substr(there.find('(') + 1)), 4096.65, 0.351);
}

// The search takes a few per cent of a run that made a result.
TEST(OwnCrossings, AreLookedForOnlyWhereTheResultCrosses) {
  const PolyMesh both = two_cubes(Vec3(0.3, 0.4, 0.6));
  const Report parted = evaluated(shapes::reference(both), two_cubes(Vec3(2, 0, 0)));
  EXPECT_FALSE(has(parted, "shape.reference_crossing_pairs"));
  EXPECT_EQ(crossing_warning(parted), "");
  // A result whose faces cross and an input whose do not: nothing is to be said of the input.
  const Report spoilt = evaluated(shapes::reference(two_cubes(Vec3(2, 0, 0))), both);
  EXPECT_TRUE(has(spoilt, "shape.reference_crossing_pairs"));
  EXPECT_EQ(crossing_warning(spoilt), "");
}

}  // namespace
}  // namespace strake
