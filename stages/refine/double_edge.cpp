#include "stages/refine/double_edge.h"

#include <algorithm>

namespace strake {

bool adds_no_double_edge(std::span<const Index> face,
                         const std::vector<std::array<Index, 3>>& triangles,
                         const PolyEdges& edges) {
  const auto is_side = [&](Index a, Index b) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (face[i] == a && face[(i + 1) % face.size()] == b) return true;
    }
    return false;
  };
  for (const auto& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = triangle[i];
      const Index b = triangle[(i + 1) % 3];
      const std::array<Index, 2> edge = {std::min(a, b), std::max(a, b)};
      if (!is_side(a, b) && std::ranges::binary_search(edges.vertices, edge)) return false;
    }
  }
  return true;
}

}  // namespace strake
