#include "common/geometry/patch_fill/fill_band.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "common/core/error.h"

namespace strake {
namespace {

using Cost = std::function<double(std::size_t, std::size_t)>;
using Triangles = std::vector<std::array<Index, 3>>;

/// Corners of two paths and what each edge between them costs; the paths may go around polygons,
/// whose first corners then are the last ones, too.
class Band {
 public:
  Band(std::size_t outer, std::size_t inner, const Cost& cost)
      : outer_(outer), inner_(inner), edges_(outer * inner) {
    for (std::size_t i = 0; i < outer; ++i) {
      for (std::size_t j = 0; j < inner; ++j) edges_[i * inner + j] = cost(i, j);
    }
  }

  /// Starts at the edge that costs least instead of the one between the first corners.
  void start_at_least() {
    const auto least = static_cast<std::size_t>(std::ranges::min_element(edges_) - edges_.begin());
    first_outer_ = least / inner_;
    first_inner_ = least % inner_;
  }

  /// The best triangles for so many steps along the outer and the inner path.
  [[nodiscard]] Triangles fill(std::size_t outer_steps, std::size_t inner_steps) const {
    // After i steps on the outer path and j on the inner one: what the edges so far cost, and
    // whether the last step was on the outer one.
    const std::size_t width = inner_steps + 1;
    std::vector<double> sum((outer_steps + 1) * width, std::numeric_limits<double>::infinity());
    std::vector<std::uint8_t> is_outer(sum.size(), 0);
    sum[0] = 0;
    for (std::size_t i = 0; i <= outer_steps; ++i) {
      for (std::size_t j = 0; j <= inner_steps; ++j) {
        if (i == 0 && j == 0) continue;
        const double own =
            edges_[(first_outer_ + i) % outer_ * inner_ + (first_inner_ + j) % inner_];
        const double by_outer =
            i > 0 ? sum[(i - 1) * width + j] : std::numeric_limits<double>::infinity();
        const double by_inner =
            j > 0 ? sum[i * width + j - 1] : std::numeric_limits<double>::infinity();
        is_outer[i * width + j] = by_outer <= by_inner ? 1 : 0;
        sum[i * width + j] = std::min(by_outer, by_inner) + own;
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
  [[nodiscard]] Index outer_corner(std::size_t i) const {
    return static_cast<Index>((first_outer_ + i) % outer_);
  }
  [[nodiscard]] Index inner_corner(std::size_t j) const {
    return static_cast<Index>(outer_ + (first_inner_ + j) % inner_);
  }

  std::size_t outer_;
  std::size_t inner_;
  std::vector<double> edges_;
  std::size_t first_outer_ = 0;
  std::size_t first_inner_ = 0;
};

}  // namespace

Triangles fill_band(std::size_t outer, std::size_t inner, const Cost& cost) {
  if (outer < 3 || inner < 3) throw PreconditionError("a polygon has three corners or more");
  Band band(outer, inner, cost);
  band.start_at_least();
  return band.fill(outer, inner);
}

Triangles fill_strip(std::size_t outer, std::size_t inner, const Cost& cost) {
  if (outer < 1 || inner < 1) throw PreconditionError("a path has a corner or more");
  return Band(outer, inner, cost).fill(outer - 1, inner - 1);
}

}  // namespace strake
