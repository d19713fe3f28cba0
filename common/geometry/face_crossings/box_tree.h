#pragma once

#include <Eigen/Geometry>
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
    std::vector<Index> open;
    if (!nodes_.empty()) open.push_back(0);
    while (!open.empty()) {
      const Node& node = nodes_[open.back()];
      const Index at = open.back();
      open.pop_back();
      if (!node.box.intersects(box)) continue;
      if (node.right != kNone) {
        open.push_back(node.right);
        open.push_back(at + 1);
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

  void build(Index begin, Index end);

  std::vector<Box> boxes_;
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

}  // namespace strake
