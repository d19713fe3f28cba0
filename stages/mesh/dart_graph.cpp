#include "stages/mesh/dart_graph.h"

namespace strake {

void DartGraph::reserve(std::size_t darts) {
  next_.reserve(darts);
  prev_.reserve(darts);
  origin_.reserve(darts);
}

Index DartGraph::add_edge(Index from, Index to) {
  const Index dart = dart_count();
  for (const Index origin : {from, to}) {
    next_.push_back(kNone);
    prev_.push_back(kNone);
    origin_.push_back(origin);
  }
  return dart;
}

Index DartGraph::connect(Index a, Index b) {
  const Index before_a = prev_[a];
  const Index before_b = prev_[b];
  const Index dart = add_edge(from(a), from(b));
  link(before_a, dart);
  link(dart, b);
  link(before_b, opposite(dart));
  link(opposite(dart), a);
  return dart;
}

Index DartGraph::split_edge(Index dart, Index node) {
  const Index other = opposite(dart);
  const Index after = next_[dart];
  const Index before_other = prev_[other];
  const Index second = add_edge(node, to(dart));
  origin_[other] = node;
  if (after == other) {  // dangling end at to(dart)
    link(second, opposite(second));
  } else {
    link(second, after);
    link(before_other, opposite(second));
  }
  link(dart, second);
  link(opposite(second), other);
  return second;
}

void DartGraph::remove_edge(Index dart) {
  const Index other = opposite(dart);
  const Index before = prev_[dart];
  const Index after = next_[dart];
  const Index before_other = prev_[other];
  const Index after_other = next_[other];
  if (after == dart) {  // a loop around nothing
    link(before_other, after_other);
  } else if (after_other == other) {
    link(before, after);
  } else {
    if (before != other) link(before, after_other);
    if (after != other) link(before_other, after);
  }
  for (const Index d : {dart, other}) next_[d] = prev_[d] = kNone;
}

void DartGraph::drop_edges(const std::vector<Index>& darts) {
  for (const Index dart : darts) {
    for (const Index d : {dart, opposite(dart)}) next_[d] = prev_[d] = kNone;
  }
}

void DartGraph::dissolve_node(Index dart) {
  const Index first = prev_[dart];
  const Index other = opposite(dart);  // comes into the node
  const Index end = to(dart);
  const Index after = next_[dart];
  const Index before_other = prev_[other];
  origin_[opposite(first)] = end;
  if (after == other) {  // dangling
    link(first, opposite(first));
  } else {
    link(first, after);
    link(before_other, opposite(first));
  }
  for (const Index d : {dart, other}) next_[d] = prev_[d] = kNone;
}

void DartGraph::contract(Index dart) {
  const Index kept = to(dart);
  const Index other = opposite(dart);
  for (Index d = rotate_ccw(dart); d != dart; d = rotate_ccw(d)) origin_[d] = kept;
  link(prev_[dart], next_[dart]);
  link(prev_[other], next_[other]);
  for (const Index d : {dart, other}) next_[d] = prev_[d] = kNone;
}

}  // namespace strake
