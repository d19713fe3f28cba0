#pragma once

#include <algorithm>
#include <vector>

#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Nodes that changes of one round have taken: what does not share any of them can still be made,
/// and is worth what it was found to be.
class ClaimedNodes {
 public:
  explicit ClaimedNodes(const PolygonGraph& graph)
      : graph_(&graph.graph()), claimed_(graph.node_count(), 0) {}

  /// All nodes, as before the first round.
  static ClaimedNodes all(const PolygonGraph& graph) {
    ClaimedNodes nodes(graph);
    nodes.claimed_.clear();
    return nodes;
  }

  /// Nodes that are newer than this count as taken.
  [[nodiscard]] bool has(Index node) const {
    return node >= static_cast<Index>(claimed_.size()) || claimed_[node] != 0;
  }
  /// Takes the origins of darts. \return false, and none is taken, where one has been before
  [[nodiscard]] bool claim(const DartLoop& darts) {
    if (std::any_of(darts.begin(), darts.end(), [&](Index d) { return has(graph_->from(d)); })) {
      return false;
    }
    for (const Index d : darts) claimed_[graph_->from(d)] = 1;
    return true;
  }

 private:
  const DartGraph* graph_;  ///< not owned
  std::vector<char> claimed_;
};

}  // namespace strake
