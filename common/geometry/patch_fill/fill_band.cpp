#include "common/geometry/patch_fill/fill_band.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "common/core/error.h"

namespace strake {
namespace {

using Cost = BandCost;
using Triangles = std::vector<std::array<Index, 3>>;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Corners of two paths and what each edge between them costs; the paths may go around polygons,
/// whose first corners then are the last ones, too.
class Band {
 public:
  Band(std::size_t outer, std::size_t inner, const Cost& cost, const Cost& least)
      : outer_(outer), inner_(inner), cost_(cost), least_(outer * inner, 0.0) {
    if (!least) return;
    for (std::size_t i = 0; i < outer; ++i) {
      for (std::size_t j = 0; j < inner; ++j) least_[i * inner + j] = least(i, j);
    }
  }

  /// Starts at the edge that costs least instead of the one between the first corners.
  void start_at_least() {
    double least = kInfinite;
    for (std::size_t i = 0; i < outer_; ++i) {
      for (std::size_t j = 0; j < inner_; ++j) {
        if (least_[i * inner_ + j] >= least) continue;
        const double own = cost_(i, j);
        if (own >= least) continue;
        least = own;
        first_outer_ = i;
        first_inner_ = j;
      }
    }
  }

  /// The best triangles for so many steps along the outer and the inner path.
  [[nodiscard]] Triangles fill(std::size_t outer_steps, std::size_t inner_steps) const {
    // No edge of the best way costs more than all of another one.
    const double most = of_short_way(outer_steps, inner_steps);
    // After i steps on the outer path and j on the inner one: what the edges so far cost, and
    // whether the last step was on the outer one.
    const std::size_t width = inner_steps + 1;
    std::vector<double> sum((outer_steps + 1) * width, kInfinite);
    std::vector<std::uint8_t> is_outer(sum.size(), 0);
    sum[0] = 0;
    for (std::size_t i = 0; i <= outer_steps; ++i) {
      for (std::size_t j = 0; j <= inner_steps; ++j) {
        if (i == 0 && j == 0) continue;
        const double by_outer = i > 0 ? sum[(i - 1) * width + j] : kInfinite;
        const double by_inner = j > 0 ? sum[i * width + j - 1] : kInfinite;
        const double before = std::min(by_outer, by_inner);
        if (before > most || least_after(i, j) > most) continue;
        is_outer[i * width + j] = by_outer <= by_inner ? 1 : 0;
        sum[i * width + j] = before + cost_after(i, j);
      }
    }
    Triangles triangles;
    for (std::size_t i = outer_steps, j = inner_steps; i + j > 0;) {
      if (is_outer[i * width + j] != 0) {
        triangles.push_back({outer_corner(i - 1), outer_corner(i), inner_corner(j)});
        --i;
      } else {
        triangles.push_back({inner_corner(j), inner_corner(j - 1), outer_corner(i)});
        --j;
      }
    }
    std::ranges::reverse(triangles);
    return triangles;
  }

 private:
  /// What the edges of the way cost that takes the shorter edge each time.
  [[nodiscard]] double of_short_way(std::size_t outer_steps, std::size_t inner_steps) const {
    double sum = 0;
    for (std::size_t i = 0, j = 0; i < outer_steps || j < inner_steps;) {
      const bool is_outer =
          j == inner_steps || (i < outer_steps && least_after(i + 1, j) <= least_after(i, j + 1));
      ++(is_outer ? i : j);
      sum += cost_after(i, j);
    }
    return sum;
  }

  /// Of the edge after so many steps on the outer and the inner path.
  [[nodiscard]] double least_after(std::size_t i, std::size_t j) const {
    return least_[(first_outer_ + i) % outer_ * inner_ + (first_inner_ + j) % inner_];
  }
  [[nodiscard]] double cost_after(std::size_t i, std::size_t j) const {
    return cost_((first_outer_ + i) % outer_, (first_inner_ + j) % inner_);
  }
  [[nodiscard]] Index outer_corner(std::size_t i) const {
    return static_cast<Index>((first_outer_ + i) % outer_);
  }
  [[nodiscard]] Index inner_corner(std::size_t j) const {
    return static_cast<Index>(outer_ + (first_inner_ + j) % inner_);
  }

  std::size_t outer_;
  std::size_t inner_;
  const Cost& cost_;
  std::vector<double> least_;  ///< [outer][inner] that edges cost at least
  std::size_t first_outer_ = 0;
  std::size_t first_inner_ = 0;
};

}  // namespace

Triangles fill_band(std::size_t outer, std::size_t inner, const Cost& cost, const Cost& least) {
  if (outer < 3 || inner < 3) throw PreconditionError("a polygon has three corners or more");
  Band band(outer, inner, cost, least);
  band.start_at_least();
  return band.fill(outer, inner);
}

Triangles fill_strip(std::size_t outer, std::size_t inner, const Cost& cost, const Cost& least) {
  if (outer < 1 || inner < 1) throw PreconditionError("a path has a corner or more");
  return Band(outer, inner, cost, least).fill(outer - 1, inner - 1);
}

}  // namespace strake
