#include "common/geometry/chain_corners.h"

#include <algorithm>
#include <array>

#include "common/geometry/segment.h"

namespace strake {

std::vector<std::size_t> corners_of_chain(std::span<const Vec3> chain, double within) {
  std::vector<std::size_t> corners;
  std::vector<std::array<std::size_t, 2>> parts;
  if (chain.size() > 2) parts.push_back({0, chain.size() - 1});
  while (!parts.empty()) {
    const auto [first, last] = parts.back();
    parts.pop_back();
    std::size_t farthest = first;
    double height = within;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double now = way_to_segment(chain[i], chain[first], chain[last]).norm();
      if (now <= height) continue;
      height = now;
      farthest = i;
    }
    if (farthest == first) continue;
    corners.push_back(farthest);
    parts.push_back({first, farthest});
    parts.push_back({farthest, last});
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace strake
