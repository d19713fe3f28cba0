#include "common/stage/pace.h"

#include <gtest/gtest.h>

namespace strake {
namespace {

TEST(Pace, IsOfUniformWork) {
  // A fifth in 2 s: 10 % a second, and 8 s for the rest.
  EXPECT_EQ(pace_text(2, 0.2), "10 %/s, 8 s left");
  EXPECT_EQ(pace_text(60, 0.25), "0.42 %/s, 3 min left");
  EXPECT_EQ(pace_text(3600, 0.25), "0.0069 %/s, 3.0 h left");
}

TEST(Pace, RoundsTimeUp) { EXPECT_EQ(pace_text(2, 0.95), "48 %/s, 1 s left"); }

TEST(Pace, SaysNothingWhereItCannotTell) {
  EXPECT_EQ(pace_text(0.5, 0.5), "");
  EXPECT_EQ(pace_text(20, 0), "");
  EXPECT_EQ(pace_text(20, 1), "");
}

}  // namespace
}  // namespace strake
