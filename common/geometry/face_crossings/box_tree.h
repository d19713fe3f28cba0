#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Finds those of a set of axis-parallel boxes that touch a given one.
class BoxTree {
 public:
  using Box = Eigen::AlignedBox3d;

  /// Cost O(n log n).
  explicit BoxTree(std::vector<Box> boxes);

  /// Calls visit(i) for every box i that touches `box`, in an order that depends on the boxes only.
  template <class Visit>
  void visit_touching(const Box& box, Visit visit) const {
    std::array<Index, kMostLevels> open;
    int count = 0;
    if (!nodes_.empty()) open[count++] = 0;
    while (count > 0) {
      const Index at = open[--count];
      const Node& node = nodes_[at];
      if (!node.box.intersects(box)) continue;
      if (node.right != kNone) {
        open[count++] = node.right;
        open[count++] = at + 1;
        continue;
      }
      for (Index k = node.begin; k < node.end; ++k) {
        if (boxes_[order_[k]].intersects(box)) visit(order_[k]);
      }
    }
  }
  [[nodiscard]] const Box& box(Index i) const { return boxes_[i]; }

 private:
  struct Node {
    Box box;
    Index begin = 0;  ///< of its part of order_
    Index end = 0;
    Index right = kNone;  ///< second child; the first one follows the node; kNone for a leaf
  };

  /// Children are halves, and of each node on the way down one waits.
  static constexpr int kMostLevels = std::numeric_limits<Index>::digits + 1;

  void build(Index at, Index begin, Index end);

  std::vector<Box> boxes_;
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

}  // namespace strake
