#include "common/geometry/face_crossings/box_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace strake {
namespace {

constexpr Index kLeafSize = 4;
/// Parts of fewer boxes are not worth a task of their own.
constexpr Index kLeastForTask = 2048;

/// Numbers of nodes of trees of `boxes` boxes and of one more.
std::pair<Index, Index> node_counts(Index boxes) {
  if (boxes < kLeafSize) return {1, 1};
  const auto [less, more] = node_counts(boxes / 2);
  const bool is_odd = boxes % 2 != 0;
  return {boxes <= kLeafSize ? 1 : 1 + less + (is_odd ? more : less),
          1 + more + (is_odd ? more : less)};
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) : boxes_(boxes.size()), order_(boxes.size()) {
  if (boxes.empty()) return;
  std::vector<Middle> middles(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    middles[i] = {boxes[i].min() + boxes[i].max(), static_cast<Index>(i)};
  }
  const auto count = static_cast<Index>(boxes.size());
  nodes_.resize(node_counts(count).first);
  build(0, 0, count, middles, boxes);
  for (Index at = 0; at < static_cast<Index>(nodes_.size()); ++at) {
    if (nodes_[at].right == kNone) leaves_.push_back(at);
  }
}

/// Builds the node `at`, and those after it that are below it.
void BoxTree::build(Index at, Index begin, Index end, std::vector<Middle>& middles,
                    const std::vector<Box>& boxes) {
  Node& node = nodes_[at];
  node.begin = begin;
  node.end = end;
  if (end - begin <= kLeafSize) {
    for (Index k = begin; k < end; ++k) {
      order_[k] = middles[k].box;
      boxes_[k] = boxes[order_[k]];
      node.box.extend(boxes_[k]);
    }
    return;
  }
  Box extent;
  for (Index k = begin; k < end; ++k) extent.extend(middles[k].at);
  Index axis = 0;
  extent.sizes().maxCoeff(&axis);
  const Index half = begin + (end - begin) / 2;
  std::nth_element(middles.begin() + begin, middles.begin() + half, middles.begin() + end,
                   [&](const Middle& a, const Middle& b) {
                     return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.box < b.box;
                   });
  const Index right = at + 1 + node_counts(half - begin).first;
  node.right = right;
  const auto build_child = [&](int child) {
    child == 0 ? build(at + 1, begin, half, middles, boxes)
               : build(right, half, end, middles, boxes);
  };
  if (end - begin < kLeastForTask) {
    build_child(0);
    build_child(1);
  } else {
    tbb::parallel_for(0, 2, build_child);
  }
  node.box = nodes_[at + 1].box.merged(nodes_[right].box);
}

}  // namespace strake
