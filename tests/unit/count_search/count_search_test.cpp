#include "strake/chain/count_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace strake {
namespace {

using CountOfScale = std::function<double(double)>;

/// Runs a search on a made-up remesher.
CountSearch search_for(std::int64_t target, const CountOfScale& count) {
  CountSearch search(target, 1, 0.01, 100);
  while (const auto scale = search.next()) {
    search.record(*scale, static_cast<std::int64_t>(std::lround(count(*scale))));
  }
  return search;
}

TEST(CountSearch, TriesTheGivenScaleFirst) {
  const CountSearch search(1000, 1.7, 0.01, 100);
  EXPECT_EQ(search.next(), 1.7);
}

TEST(CountSearch, StopsAtOnceWhereTheCountFits) {
  const CountSearch search = search_for(1000, [](double) { return 1020; });
  EXPECT_EQ(search.trial_count(), 1u);
}

TEST(CountSearch, GoesOnWhereMoreIsMissingThanMayBe) {
  const CountSearch search = search_for(1000, [](double scale) { return 975 / (scale * scale); });
  EXPECT_EQ(search.trial_count(), 2u);
  EXPECT_TRUE(search.is_good_enough(search.best().count));
}

/// Counts of real meshes fall with the scale to a power between 1 (one family fixed) and 2 (both
/// free), more slowly where the largest spacing binds.
TEST(CountSearch, MeetsTheTargetForPowerLaws) {
  for (const double power : {0.7, 1.0, 1.5, 2.0, 2.6}) {
    for (const double target : {300.0, 1000.0, 5000.0, 20000.0}) {
      const auto search = search_for(static_cast<std::int64_t>(target),
                                     [&](double scale) { return 2000 * std::pow(scale, -power); });
      EXPECT_TRUE(search.is_good_enough(search.best().count))
          << "power " << power << " target " << target;
    }
  }
}

TEST(CountSearch, MeetsTheTargetWhereAFixedPartOfTheCountIsFromFeatures) {
  const auto search =
      search_for(3000, [](double scale) { return 1500 + 4000 * std::pow(scale, -1.8); });
  EXPECT_TRUE(search.is_good_enough(search.best().count));
}

TEST(CountSearch, ToleratesNoise) {
  const auto search = search_for(2500, [](double scale) {
    return 4000 * std::pow(scale, -1.6) * (1 + 0.02 * std::sin(40 * scale));
  });
  EXPECT_LE(search.error(search.best().count), 0.05);
}

/// A line more or less makes counts go up where they should fall.
TEST(CountSearch, GoesOnBesideACountThatIsOutOfOrder) {
  const auto search = search_for(800, [](double scale) {
    if (scale < 0.93) return 845;
    return scale < 0.97 ? 880 : scale < 1 ? 790 : 672;
  });
  EXPECT_EQ(search.best().count, 790);
}

/// Lines fit into the shape twice too often, or hardly at all.
TEST(CountSearch, HardlyAnyAreFartherOffThanTwiceAsMany) {
  const auto search = search_for(300, [](double scale) { return scale < 1.05 ? 715 : 4; });
  EXPECT_GT(search.trial_count(), 2u);
  EXPECT_EQ(search.best().count, 715);
}

TEST(CountSearch, RemembersTheBestWhereTheTargetIsOutOfReach) {
  const auto search = search_for(100, [](double scale) { return std::max(800.0, 2000 / scale); });
  EXPECT_EQ(search.best().count, 800);
  EXPECT_LE(search.trial_count(), static_cast<std::size_t>(CountSearch::kMaxTrials));
}

TEST(CountSearch, StaysWithinTheLimitsOfTheScale) {
  CountSearch search(10, 1, 0.5, 2);
  while (const auto scale = search.next()) {
    EXPECT_GE(*scale, 0.5);
    EXPECT_LE(*scale, 2);
    search.record(*scale, 1000);
  }
  EXPECT_GE(search.trial_count(), 2u);
}

TEST(CountSearch, SurvivesAnEmptyResult) {
  const auto search = search_for(500, [](double scale) { return scale > 0.5 ? 0 : 500; });
  EXPECT_EQ(search.best().count, 500);
}

}  // namespace
}  // namespace strake
