#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/mesh_support.h"
#include "tests/unit/evaluate/evaluated.h"
#include "tests/unit/evaluate/shapes.h"

namespace strake {
namespace {

/// A bar 10 long and 1 wide, of `n` x `n` quads a side.
PolyMesh bar(Index n, double height) {
  return shapes::moved(shapes::cube(n, 0.5),
                       [&](const Vec3& p) { return Vec3(10 * p.x(), p.y(), height * p.z()); });
}

Report report_on(const PolyMesh& reference, const PolyMesh& candidate) {
  return evaluated(shapes::reference(reference), candidate);
}

bool is_warned(const Report& report) {
  return std::ranges::any_of(report.warnings(), [](const std::string& warning) {
    return warning.find("thick there now") != std::string::npos;
  });
}

// Cells of the bar of 6 faces are as long as the root of its area, 42, over 6: 2.6.
TEST(Thickness, AFlattenedBarIsNamed) {
  const Report report = report_on(bar(8, 1), bar(1, 0.4));
  // The sides of 10 x 1 above and below have lost 0.6 of 1; all of the bar is thin but its ends,
  // which are 10 apart.
  EXPECT_NEAR(number(report, "thickness.thin_share"), 40.0 / 42, 1e-3);
  EXPECT_NEAR(number(report, "thickness.changed_share"), 20.0 / 42, 1e-2);
  EXPECT_NEAR(number(report, "thickness.worst"), 1, 1e-4);
  EXPECT_NEAR(number(report, "thickness.worst_now"), 0.4, 1e-4);
  EXPECT_TRUE(is_warned(report));
  EXPECT_TRUE(is_warned(report_on(bar(8, 1), bar(1, 1e-3))));
  // One that is half as thick again.
  EXPECT_TRUE(is_warned(report_on(bar(8, 1), bar(1, 1.5))));
}

TEST(Thickness, SmallChangesAndThickPartsAreNot) {
  EXPECT_FALSE(is_warned(report_on(bar(8, 1), bar(1, 1))));
  EXPECT_FALSE(is_warned(report_on(bar(8, 1), bar(1, 0.7))));
  // Cells a tenth as long as the bar is thick: what is missing is a matter of distance.
  const Report thick = report_on(bar(8, 1), bar(32, 0.4));
  EXPECT_EQ(number(thick, "thickness.thin_share"), 0);
  EXPECT_FALSE(is_warned(thick));
}

TEST(Thickness, WhatMovesAsAWholeKeepsIt) {
  for (const Vec3& shift : {Vec3(0, 0, 0.6), Vec3(0, 0, -0.9), Vec3(0, 0.7, 0.7)}) {
    const PolyMesh moved =
        shapes::moved(bar(1, 1), [&](const Vec3& p) -> Vec3 { return p + shift; });
    EXPECT_FALSE(is_warned(report_on(bar(8, 1), moved))) << shift.transpose();
  }
}

// Along the edge of a wedge, or of a groove, there is always a place that is as thin as one likes.
TEST(Thickness, ABluntedEdgeIsNoThinPart) {
  // A bar whose sides meet above it in an edge, `open` apart below it, and the edge cut off.
  const auto wedge = [](Index n, double open, double top) {
    return shapes::moved(bar(n, 2), [&](const Vec3& p) {
      const double left = (1 - p.z()) / 2;  // 1 below, 0 above
      const double up = std::min(p.z(), top);
      return Vec3(p.x(), p.y() * open * (left + 0.01), up);
    });
  };
  // 44 degrees.
  EXPECT_FALSE(is_warned(report_on(wedge(16, 1.6, 1), wedge(2, 1.6, 0.5))));
}

// Between the bottom of the upper bar and the top of the lower one there is no part.
TEST(Thickness, IsThatOfOneComponent) {
  const auto bars = [](Index n, double down) {
    return support::together(support::transformed(bar(n, 1), Mat3::Identity(), Vec3(0, 0, -down)),
                             support::transformed(bar(n, 1), Mat3::Identity(), Vec3(0, 0, 0.5)));
  };
  const Report report = report_on(bars(8, 0), bars(1, 0.5));
  EXPECT_EQ(number(report, "thickness.changed_share"), 0);
  EXPECT_FALSE(is_warned(report));
}

TEST(Thickness, PlacesAreThoseOfTheFile) {
  const Vec3 far(1000, 0, 0);
  const auto shifted = [&](const PolyMesh& mesh) {
    return shapes::moved(mesh, [&](const Vec3& p) -> Vec3 { return p + far; });
  };
  TriMesh reference = shapes::reference(bar(8, 1));
  reference.origin = far;
  EvaluateOptions options;
  options.samples = 2000;
  SilentObserver observer;
  const Report report =
      evaluate_mesh(reference, nullptr, shifted(bar(1, 0.4)), options, observer).report;
  ASSERT_TRUE(is_warned(report));
  const std::string warning = report.warnings().back();
  // The bar reaches from 995 to 1005.
  const double x = std::stod(warning.substr(warning.find('(') + 1));
  EXPECT_NEAR(x, 1000, 5);
}

}  // namespace
}  // namespace strake
