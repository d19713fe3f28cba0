#include "common/geometry/face_crossings/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace strake {
namespace {
constexpr Index kLeafSize = 4;
}

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), Index{0});
  nodes_.reserve(boxes_.size());
  if (!boxes_.empty()) build(0, static_cast<Index>(order_.size()));
}

void BoxTree::build(Index begin, Index end) {
  const auto at = static_cast<Index>(nodes_.size());
  nodes_.emplace_back();
  Box whole;
  Box middles;
  for (Index k = begin; k < end; ++k) {
    whole.extend(boxes_[order_[k]]);
    middles.extend(boxes_[order_[k]].center());
  }
  nodes_[at].box = whole;
  nodes_[at].begin = begin;
  nodes_[at].end = end;
  if (end - begin <= kLeafSize) return;
  Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const Index half = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                   [&](Index a, Index b) {
                     const double x = boxes_[a].min()[axis] + boxes_[a].max()[axis];
                     const double y = boxes_[b].min()[axis] + boxes_[b].max()[axis];
                     return std::pair(x, a) < std::pair(y, b);
                   });
  build(begin, half);
  nodes_[at].right = static_cast<Index>(nodes_.size());
  build(half, end);
}

}  // namespace strake
