#pragma once

#include "stages/mesh/polygon_graph.h"
#include "stages/mesh/strip.h"

namespace strake {

/// What `meet_vertex_count` did.
struct StripCounts {
  Index split = 0;
  Index collapsed = 0;
};

/// Brings the number of vertices nearer to a wanted one by splitting strips of quads or taking them
/// out: between odd faces, to the boundary, and around the surface.
///
/// The cheapest strips come first, by price and shapes for each vertex; odd faces at their ends are
/// a gain. The number may stay apart from the wanted one by less than the shortest strip left.
/// \pre faces are convex; they stay so
/// \param wanted     wanted length of an edge
/// \param odd_price  what a face that is no quad costs, beside shape penalties (see shape_penalty)
StripCounts meet_vertex_count(PolygonGraph& graph, const EdgeLength& wanted, double odd_price,
                              Index vertices);

}  // namespace strake
