#pragma once

#include <set>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Adds to a part of a mesh what it encloses: what else is joined to it by edges, reaches no
/// boundary, and has no more faces.
/// \param for_neighbours  (face, visit): calls visit for each face beside a face; kNone: a boundary
template <class ForNeighbours>
void add_enclosed(std::set<Index>& part, const ForNeighbours& for_neighbours) {
  const std::unordered_set<Index> is_in(part.begin(), part.end());
  std::unordered_map<Index, Index> seen_from;
  std::vector<Index> enclosed;
  for (const Index f : part) {
    for_neighbours(f, [&](Index start) {
      if (start == kNone || is_in.contains(start) || !seen_from.emplace(start, start).second)
        return;
      std::vector<Index> outside = {start};
      bool is_open = false;
      for (std::size_t i = 0; i < outside.size() && outside.size() <= part.size(); ++i) {
        for_neighbours(outside[i], [&](Index g) {
          if (g == kNone) {
            is_open = true;
          } else if (!is_in.contains(g)) {
            const auto [at, is_new] = seen_from.emplace(g, start);
            if (is_new) outside.push_back(g);
            is_open = is_open || at->second != start;  // of what was too large
          }
        });
      }
      if (!is_open && outside.size() <= part.size()) {
        enclosed.insert(enclosed.end(), outside.begin(), outside.end());
      }
    });
  }
  part.insert(enclosed.begin(), enclosed.end());
}

}  // namespace strake
