#pragma once

#include <functional>

#include "stages/mesh/polygon_graph.h"

namespace strake {

/// What `simplify` did.
struct SimplifyCounts {
  Index contracted_edges = 0;
  Index removed_bigons = 0;
  Index removed_loops = 0;
  Index dissolved_nodes = 0;
  Index split_edges = 0;  ///< loops, double edges and strongly bent features and boundaries
};

/// Wanted edge length at a node, model units.
using LocalSize = std::function<double(const SurfaceNode&)>;

/// Which edges are contracted, in wanted edge lengths.
struct SimplifyLimits {
  double shortest = 0;         ///< those below this length
  double corner_distance = 1;  ///< corners only where they come to lie this near to features
};

/// Brings the cells into the form of a polygon mesh: merges crossings that nearly coincide by edge
/// contraction under the link condition, removes cells of two sides and tiny ones of one, and
/// divides edges until no two nodes are joined twice.
///
/// Never merges across feature or boundary lines, and never changes the topology of the surface.
SimplifyCounts simplify(PolygonGraph& graph, const LocalSize& size, const SimplifyLimits& limits);

/// Merges from(dart) into to(dart), and removes cells of two sides that this leaves.
/// \pre can_contract(graph, dart)
SimplifyCounts contract_edge(PolygonGraph& graph, Index dart);

/// Removes one edge of a cell with two sides, the less important one. \return whether it was one
bool remove_bigon(PolygonGraph& graph, Index dart);

/// Whether merging from(dart) into to(dart) leaves a surface of the same topology whose features
/// and boundaries stay: link condition and ranks.
bool keeps_topology(const PolygonGraph& graph, Index dart);

/// Whether, besides, no face turns over.
bool can_contract(const PolygonGraph& graph, Index dart);

}  // namespace strake
