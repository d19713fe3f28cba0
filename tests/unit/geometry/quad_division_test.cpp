#include "common/geometry/quad_division.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>

namespace strake {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr auto kFree = [](std::size_t, std::size_t) { return 0.0; };

/// Prices at random, the same for the same quad.
class RandomPrices {
 public:
  explicit RandomPrices(unsigned seed) : random_(seed) {}

  double operator()(std::size_t i, std::size_t a, std::size_t b, std::size_t j) {
    const auto [at, is_new] = prices_.try_emplace({i, a, b, j}, 0);
    if (is_new) at->second = std::uniform_real_distribution<double>(0, 1)(random_);
    return at->second;
  }

 private:
  std::mt19937 random_;
  std::map<std::array<std::size_t, 4>, double> prices_;
};

/// Of all divisions of the corners from i to j, one by one.
double least_price(RandomPrices& price, const DiagonalPrice& diagonal, std::size_t i,
                   std::size_t j) {
  double least = kInfinity;
  const auto beyond = [&](std::size_t from, std::size_t to) {
    return to - from == 1 ? 0 : least_price(price, diagonal, from, to) + diagonal(from, to);
  };
  for (std::size_t a = i + 1; a < j; a += 2) {
    for (std::size_t b = a + 1; b < j; b += 2) {
      least = std::min(least, price(i, a, b, j) + beyond(i, a) + beyond(a, b) + beyond(b, j));
    }
  }
  return least;
}

/// Diagonals that others than one corner pay for.
double paid_for(std::size_t i, std::size_t j) { return i != 2 && j != 2 ? -1.5 : 0.2; }

TEST(QuadDivision, IsTheCheapestOfAll) {
  for (const DiagonalPrice& diagonal : {DiagonalPrice(kFree), DiagonalPrice(paid_for)}) {
    for (const std::size_t n : {4, 6, 8, 10, 12}) {
      for (unsigned seed = 0; seed < 10; ++seed) {
        RandomPrices price(seed);
        const auto division = cheapest_division(n, std::ref(price), diagonal);
        ASSERT_TRUE(division.has_value());
        EXPECT_EQ(division->quads.size(), n / 2 - 1);
        EXPECT_EQ(division->diagonals.size(), n / 2 - 2);
        double sum = 0;
        for (const auto& [i, a, b, j] : division->quads) sum += price(i, a, b, j);
        for (const auto& [i, j] : division->diagonals) sum += diagonal(i, j);
        EXPECT_NEAR(sum, least_price(price, diagonal, 0, n - 1), 1e-12);
      }
    }
  }
}

TEST(QuadDivision, SidesOfQuadsAreSidesOrDiagonalsOfTheRest) {
  RandomPrices price(7);
  const std::size_t n = 12;
  const auto division = cheapest_division(n, std::ref(price), kFree);
  ASSERT_TRUE(division.has_value());
  std::map<std::pair<std::size_t, std::size_t>, int> uses;
  for (const auto& quad : division->quads) {
    for (std::size_t k = 0; k < 4; ++k) ++uses[std::minmax(quad[k], quad[(k + 1) % 4])];
  }
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(uses[std::minmax(i, (i + 1) % n)], 1);
  for (const auto& diagonal : division->diagonals) EXPECT_EQ(uses[diagonal], 2);
  EXPECT_EQ(uses.size(), n + division->diagonals.size());
}

TEST(QuadDivision, AvoidsWhatMustNotBe) {
  // Of a hexagon there are three divisions, one for each long diagonal.
  const auto even = [](std::size_t, std::size_t, std::size_t, std::size_t) { return 1.0; };
  const auto but_one = [](std::size_t i, std::size_t) { return i == 1 ? 0 : kInfinity; };
  const auto division = cheapest_division(6, even, but_one);
  ASSERT_TRUE(division.has_value());
  EXPECT_EQ(division->diagonals.front(), (std::pair<std::size_t, std::size_t>{1, 4}));
  const auto none = [](std::size_t, std::size_t) { return kInfinity; };
  EXPECT_FALSE(cheapest_division(6, even, none).has_value());
}

}  // namespace
}  // namespace strake
