#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Disjoint sets of 0 .. count - 1 whose representative is their lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(Index count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// \return whether they were two
  bool unite(Index a, Index b) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    parent_[high] = low;
    return low != high;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace strake
