#pragma once

#include <functional>

#include "stages/mesh/polygon_graph.h"

/// Makes all faces quads: odd ones that are left are joined along the cheapest ways between them,
/// and pieces too small for that are divided.
namespace strake {

/// Divides cells into a quad for each corner, by the middles of their edges and a node inside.
/// \param is_divided  whether a cell is, by a dart of it; the same for all cells that are joined
void divide_into_quads(PolygonGraph& graph, const std::function<bool(Index)>& is_divided);

/// Joins each odd face to the nearest other one, or to the boundary, by splitting the quads along
/// the cheapest way between them. The way may turn in a quad, which is divided in three then.
/// \pre no face has more than five sides
/// \return ways made
Index join_odd_faces(PolygonGraph& graph);

}  // namespace strake
