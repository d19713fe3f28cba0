#include "common/geometry/face_crossings/box_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
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

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), Index{0});
  if (boxes_.empty()) return;
  const auto count = static_cast<Index>(boxes_.size());
  nodes_.resize(node_counts(count).first);
  build(0, 0, count);
}

/// Builds the node `at`, and those after it that are below it.
void BoxTree::build(Index at, Index begin, Index end) {
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
  const Index right = at + 1 + node_counts(half - begin).first;
  nodes_[at].right = right;
  const auto build_child = [&](int child) {
    child == 0 ? build(at + 1, begin, half) : build(right, half, end);
  };
  if (end - begin < kLeastForTask) {
    build_child(0);
    build_child(1);
  } else {
    tbb::parallel_for(0, 2, build_child);
  }
}

}  // namespace strake
