#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Finds those of a set of axis-parallel boxes that touch a given one, or each other.
class BoxTree {
 public:
  using Box = Eigen::AlignedBox3d;

  /// Cost O(n log n).
  explicit BoxTree(const std::vector<Box>& boxes);

  /// Calls visit(i) for every box i that touches `box`, in an order that depends on the boxes only.
  template <class Visit>
  void visit_touching(const Box& box, Visit visit) const {
    visit_from(0, box, [&](Index k) {
      visit(order_[k]);
      return true;
    });
  }
  /// The same as long as `visit` returns true.
  template <class Visit>
  void visit_touching_while(const Box& box, Visit visit) const {
    visit_from(0, box, [&](Index k) { return visit(order_[k]); });
  }

  /// Parts into which the pairs of boxes that touch each other fall.
  [[nodiscard]] Index part_count() const { return static_cast<Index>(leaves_.size()); }
  /// Calls visit(i, j) for the pairs of one part, of two different boxes; over all parts once for
  /// every pair.
  template <class Visit>
  void visit_touching_pairs(Index part, Visit visit) const {
    const Node& leaf = nodes_[leaves_[part]];
    for (Index a = leaf.begin; a + 1 < leaf.end; ++a) {
      for (Index b = a + 1; b < leaf.end; ++b) {
        if (boxes_[a].intersects(boxes_[b])) visit(order_[a], order_[b]);
      }
    }
    visit_from(leaf.end, leaf.box, [&](Index b) {
      for (Index a = leaf.begin; a < leaf.end; ++a) {
        if (boxes_[a].intersects(boxes_[b])) visit(order_[a], order_[b]);
      }
      return true;
    });
  }

 private:
  struct Node {
    Box box;
    Index begin = 0;  ///< of its part of boxes_
    Index end = 0;
    Index right = kNone;  ///< second child; the first one follows the node; kNone for a leaf
  };
  /// What is sorted: the sum of both corners of a box, and its number.
  struct Middle {
    Vec3 at;
    Index box;
  };

  /// Children are halves, and of each node on the way down one waits.
  static constexpr int kMostLevels = std::numeric_limits<Index>::digits + 1;

  /// Calls visit(k) for each of boxes_ that touches `box`, in leaves that end after `first`, as
  /// long as it returns true.
  template <class Visit>
  void visit_from(Index first, const Box& box, Visit visit) const {
    std::array<Index, kMostLevels> open;
    int count = 0;
    if (!nodes_.empty()) open[count++] = 0;
    while (count > 0) {
      const Index at = open[--count];
      const Node& node = nodes_[at];
      if (node.end <= first || !node.box.intersects(box)) continue;
      if (node.right != kNone) {
        open[count++] = node.right;
        open[count++] = at + 1;
        continue;
      }
      for (Index k = node.begin; k < node.end; ++k) {
        if (boxes_[k].intersects(box) && !visit(k)) return;
      }
    }
  }

  void build(Index at, Index begin, Index end, std::vector<Middle>& middles,
             const std::vector<Box>& boxes);

  std::vector<Box> boxes_;     ///< in the order of the leaves
  std::vector<Index> order_;   ///< their numbers
  std::vector<Node> nodes_;    ///< each before those below it
  std::vector<Index> leaves_;  ///< nodes
};

}  // namespace strake
