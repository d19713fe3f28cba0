#include "common/core/place_text.h"

#include <gtest/gtest.h>

namespace strake {
namespace {

// Two places that are a ten-thousandth of the diagonal apart have different texts, near the origin
// and far from it.
TEST(PlaceText, TellsPlacesApart) {
  for (const double diagonal : {1e-6, 1.0, 300.0}) {
    for (const double away : {0.0, 1.0, 1e4}) {
      const Vec3 place = diagonal * Vec3(away + 0.3, 0.2, -0.1);
      const Vec3 beside = place + 1.01e-4 * diagonal * Vec3::UnitX();
      EXPECT_NE(place_text(place, diagonal), place_text(beside, diagonal)) << diagonal << away;
    }
  }
}

TEST(PlaceText, IsNoLongerThanNeeded) {
  EXPECT_EQ(place_text(Vec3(0.123456, -2, 1e-9), 1), "(0.12346, -2, 1e-09)");
  EXPECT_EQ(place_text(Vec3(5400123.4, 0, 0), 1000), "(5400123.4, 0, 0)");
  EXPECT_EQ(place_text(Vec3::Zero(), 0), "(0, 0, 0)");
}

}  // namespace
}  // namespace strake
