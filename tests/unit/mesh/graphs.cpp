#include "tests/unit/mesh/graphs.h"

#include <set>
#include <vector>

#include "common/core/observer.h"
#include "common/geometry/topology/topology.h"

namespace strake {

GraphCounts count(const DartGraph& graph) {
  GraphCounts counts;
  std::set<Index> nodes;
  std::vector<char> in_cell(graph.dart_count(), 0);
  std::vector<char> in_part(graph.dart_count(), 0);
  for (Index d = 0; d < graph.dart_count(); ++d) {
    if (!graph.is_alive(d)) continue;
    nodes.insert(graph.from(d));
    counts.edges += d % 2 == 0;
    counts.loose_ends += graph.rotate_ccw(d) == d;
    if (in_cell[d] == 0) {
      ++counts.cells;
      for (Index at = d; in_cell[at] == 0; at = graph.next(at)) in_cell[at] = 1;
    }
    if (in_part[d] != 0) continue;
    ++counts.parts;
    std::vector<Index> stack = {d};
    in_part[d] = 1;
    while (!stack.empty()) {
      const Index at = stack.back();
      stack.pop_back();
      for (const Index other : {graph.next(at), DartGraph::opposite(at)}) {
        if (in_part[other] != 0) continue;
        in_part[other] = 1;
        stack.push_back(other);
      }
    }
  }
  counts.nodes = static_cast<Index>(nodes.size());
  return counts;
}

::testing::AssertionResult is_consistent(const DartGraph& graph) {
  for (Index d = 0; d < graph.dart_count(); ++d) {
    if (graph.is_alive(d) != graph.is_alive(DartGraph::opposite(d))) {
      return ::testing::AssertionFailure() << "half of edge " << d / 2 << " is gone";
    }
    if (!graph.is_alive(d)) continue;
    const Index after = graph.next(d);
    if (!graph.is_alive(after) || graph.prev(after) != d) {
      return ::testing::AssertionFailure() << "dart " << d << " is not before its next, " << after;
    }
    if (graph.from(after) != graph.to(d)) {
      return ::testing::AssertionFailure() << "dart " << d << " does not lead to its next";
    }
  }
  return ::testing::AssertionSuccess();
}

std::vector<Index> darts_around(const DartGraph& graph, Index dart) {
  std::vector<Index> darts = {dart};
  for (Index d = graph.rotate_ccw(dart); d != dart; d = graph.rotate_ccw(d)) darts.push_back(d);
  return darts;
}

Overlay overlay_of(const TriMesh& mesh, const LineSet& lines) {
  SilentObserver observer;
  return build_overlay(mesh, lines, observer);
}

Index closed_euler(const TriMesh& mesh) {
  const Census c = census(mesh);
  return c.euler_characteristic + c.boundary_loops;
}

}  // namespace strake
