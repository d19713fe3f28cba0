#include "common/core/wanted_count.h"

#include <gtest/gtest.h>

namespace strake {
namespace {

TEST(WantedCount, WhatIsNearEnoughIsNotSpokenOf) {
  EXPECT_EQ(missed_count({Counted::vertices, 1000, 1050, 0}, "it has", "why"), "");
  EXPECT_EQ(missed_count({Counted::vertices, 1000, 950, 2000}, "it has", "why"), "");
}

TEST(WantedCount, BothDirectionsAreToldWithTheReason) {
  EXPECT_EQ(missed_count({Counted::vertices, 1000, 1051, 0}, "it has", "why"),
            "1000 vertices were wanted, but it has 1051: why");
  EXPECT_EQ(missed_count({Counted::faces, 1000, 949, 2000}, "it has", "why"),
            "1000 faces were wanted, but it has 949: why");
}

TEST(WantedCount, CornersAreTheReasonWhereTheyAreMoreThanWanted) {
  const std::string said = missed_count({Counted::vertices, 100, 130, 120}, "it has", "why");
  EXPECT_NE(said.find("120 corners"), std::string::npos) << said;
  EXPECT_NE(missed_count({Counted::vertices, 100, 130, 100}, "it has", "why").find(": why"),
            std::string::npos);
  EXPECT_NE(missed_count({Counted::vertices, 100, 80, 120}, "it has", "why").find(": why"),
            std::string::npos);  // they are no reason for too few
}

}  // namespace
}  // namespace strake
