#include "common/geometry/patch_fill/fill_band.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "common/core/error.h"

namespace strake {

std::vector<std::array<Index, 3>> fill_band(
    std::size_t outer, std::size_t inner,
    const std::function<double(std::size_t, std::size_t)>& cost) {
  if (outer < 3 || inner < 3) throw PreconditionError("a polygon has three corners or more");
  std::vector<double> edges(outer * inner);
  for (std::size_t i = 0; i < outer; ++i) {
    for (std::size_t j = 0; j < inner; ++j) edges[i * inner + j] = cost(i, j);
  }
  const auto first = static_cast<std::size_t>(std::ranges::min_element(edges) - edges.begin());
  const std::size_t first_outer = first / inner;
  const std::size_t first_inner = first % inner;

  // After i steps on the outer polygon and j on the inner one: what the edges so far cost, and
  // whether the last step was on the outer one.
  const std::size_t width = inner + 1;
  std::vector<double> sum((outer + 1) * width, std::numeric_limits<double>::infinity());
  std::vector<std::uint8_t> is_outer(sum.size(), 0);
  sum[0] = 0;
  for (std::size_t i = 0; i <= outer; ++i) {
    for (std::size_t j = 0; j <= inner; ++j) {
      if (i == 0 && j == 0) continue;
      const double own = edges[(first_outer + i) % outer * inner + (first_inner + j) % inner];
      const double by_outer =
          i > 0 ? sum[(i - 1) * width + j] : std::numeric_limits<double>::infinity();
      const double by_inner =
          j > 0 ? sum[i * width + j - 1] : std::numeric_limits<double>::infinity();
      is_outer[i * width + j] = by_outer <= by_inner ? 1 : 0;
      sum[i * width + j] = std::min(by_outer, by_inner) + own;
    }
  }

  std::vector<std::array<Index, 3>> triangles;
  const auto outer_corner = [&](std::size_t i) {
    return static_cast<Index>((first_outer + i) % outer);
  };
  const auto inner_corner = [&](std::size_t j) {
    return static_cast<Index>(outer + (first_inner + j) % inner);
  };
  for (std::size_t i = outer, j = inner; i + j > 0;) {
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

}  // namespace strake
