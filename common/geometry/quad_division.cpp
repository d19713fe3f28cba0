#include "common/geometry/quad_division.h"

#include <limits>

namespace strake {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Over the chords (i, j) that close the run of corners from i to j.
class Division {
 public:
  Division(std::size_t corners, const QuadPrice& quad, const DiagonalPrice& diagonal)
      : corners_(corners),
        quad_(quad),
        diagonal_(diagonal),
        best_(corners * corners, kUnknown),
        chord_(corners * corners, kUnknown),
        choice_(corners * corners) {}

  std::optional<QuadDivision> run() {
    if (!(best(0, corners_ - 1) < kInfinity)) return std::nullopt;
    QuadDivision division;
    collect(0, corners_ - 1, division);
    return division;
  }

 private:
  static constexpr double kUnknown = -kInfinity;

  double chord(std::size_t i, std::size_t j) {
    if (j - i == 1) return 0;
    double& known = chord_[i * corners_ + j];
    if (known == kUnknown) {
      known = best(i, j);
      if (known < kInfinity) known += diagonal_(i, j);
    }
    return known;
  }

  /// Least price of the corners from i to j, closed by the chord between these.
  double best(std::size_t i, std::size_t j) {
    double& known = best_[i * corners_ + j];
    if (known != kUnknown) return known;
    double least = kInfinity;
    for (std::size_t a = i + 1; a < j; a += 2) {
      for (std::size_t b = a + 1; b < j; b += 2) {
        const double shape = quad_(i, a, b, j);
        if (!(shape < kInfinity)) continue;
        const double price = shape + chord(i, a) + chord(a, b) + chord(b, j);
        if (!(price < least)) continue;
        least = price;
        choice_[i * corners_ + j] = {a, b};
      }
    }
    return best_[i * corners_ + j] = least;
  }

  void collect(std::size_t i, std::size_t j, QuadDivision& division) const {
    const auto [a, b] = choice_[i * corners_ + j];
    division.quads.push_back({i, a, b, j});
    for (const auto& [from, to] : {std::pair{i, a}, std::pair{a, b}, std::pair{b, j}}) {
      if (to - from == 1) continue;
      division.diagonals.emplace_back(from, to);
      collect(from, to, division);
    }
  }

  std::size_t corners_;
  const QuadPrice& quad_;
  const DiagonalPrice& diagonal_;
  std::vector<double> best_;                                 ///< [n * n]
  std::vector<double> chord_;                                ///< [n * n] best_, and the diagonal
  std::vector<std::pair<std::size_t, std::size_t>> choice_;  ///< [n * n]
};

}  // namespace

std::optional<QuadDivision> cheapest_division(std::size_t corners, const QuadPrice& quad,
                                              const DiagonalPrice& diagonal) {
  return Division(corners, quad, diagonal).run();
}

}  // namespace strake
