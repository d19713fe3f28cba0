#include "strake/run/resources.h"

#include <gtest/gtest.h>

namespace strake {
namespace {

TEST(Resources, AmountsOfMemory) {
  EXPECT_EQ(parse_bytes("0"), 0);
  EXPECT_EQ(parse_bytes("300B"), 300);
  EXPECT_EQ(parse_bytes("1.5 GB"), 1.5e9);
  EXPECT_EQ(parse_bytes("2GiB"), 2147483648.0);
  EXPECT_EQ(parse_bytes("4G"), parse_bytes("4GiB")) << "as Slurm has it";
  EXPECT_EQ(parse_bytes("1e3kB"), 1e6);
  for (const char* bad : {"", "GB", "-1GB", "1gb", "1 G B", "1XB", "nan", "inf", "1e400", "1e12TB",
                          "4000", "two", "5s", "1,5GB"}) {
    EXPECT_EQ(parse_bytes(bad), std::nullopt) << bad;
  }
}

TEST(Resources, AmountsOfTime) {
  EXPECT_EQ(parse_seconds("90s"), 90);
  EXPECT_EQ(parse_seconds("0"), 0);
  EXPECT_EQ(parse_seconds("10min"), 600);
  EXPECT_EQ(parse_seconds("2 h"), 7200);
  EXPECT_EQ(parse_seconds("30d"), 30 * 86400);
  EXPECT_DOUBLE_EQ(parse_seconds("15us").value(), 15e-6);
  for (const char* bad : {"", "min", "-1s", "1m", "2GB", "1e30d", "30", "0.5"}) {
    EXPECT_EQ(parse_seconds(bad), std::nullopt) << bad;
  }
}

TEST(Resources, TextsNameTheUnit) {
  EXPECT_EQ(bytes_text(999), "999 B");
  EXPECT_EQ(bytes_text(25.1e6), "25.1 MB");
  EXPECT_EQ(bytes_text(1.5e9), "1.5 GB");
  EXPECT_EQ(seconds_text(0.075), "75 ms");
  EXPECT_EQ(seconds_text(1.5), "1.5 s");
  EXPECT_EQ(seconds_text(720), "12 min");
  EXPECT_EQ(seconds_text(7200), "2.0 h");
}

TEST(Resources, NeedsGrowWithTheFacesAndStayANumber) {
  const Resources needs = {100, 2, 10, 0.5, 0, 3, 0.1};
  EXPECT_EQ(needs.memory(50, 0), 200);
  EXPECT_EQ(needs.memory(50, 10), 230);
  EXPECT_EQ(needs.time(50, 0), 35);
  EXPECT_EQ(needs.time(50, 10), 36);
  const Resources absurd = {1e18, 1e18, 0, 0, 0, 1e18, 0};
  EXPECT_GT(absurd.memory(1e9, 1e9), 0);
  const Resources endless = {0, 0, 1e18, 1e18, 0, 0, 1e18};
  EXPECT_LE(endless.time(1e9, 1e9), 1e18);
}

/// Measured on a model of 11,092 faces, for a count and within a tolerance.
TEST(Resources, AreEnoughForFineResults) {
  constexpr double kFaces = 11092;
  constexpr double kCount = 500000;
  EXPECT_GE(default_resources("trace").memory(kFaces, kCount), 377e6);
  EXPECT_GE(default_resources("mesh").memory(kFaces, kCount), 335e6);
  EXPECT_GE(default_resources("fit").memory(kFaces, kCount), 1862e6);
  EXPECT_GE(default_resources("fit").memory(kFaces, vertices_within(1e-5)), 506e6);
  EXPECT_GE(default_resources("evaluate").memory(kFaces, kCount), 531e6);
  EXPECT_LT(default_resources("fit").memory(kFaces, 2000), 100e6) << "small ones run abreast";
}

TEST(Resources, FacesAreNeverEstimatedFarTooLow) {
  EXPECT_EQ(estimated_faces(84 + 50 * 1000, ".stl"), (84 + 50 * 1000) / 50.0);
  EXPECT_GE(estimated_faces(1000, ".ply"), 50);
  EXPECT_GE(estimated_faces(1000, ".unknown"), 50);
}

}  // namespace
}  // namespace strake
