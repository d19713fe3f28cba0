#pragma once

#include <functional>

#include "stages/mesh/polygon_graph.h"

namespace strake {

// Quads of all faces: odd ones that are left are joined along the cheapest ways between them, and
// pieces too small for that are divided.

/// Divides cells into a quad for each corner, by the middles of their edges and a node inside.
/// \param is_divided  whether a cell is, by a dart of it; the same for all cells that are joined
void divide_into_quads(PolygonGraph& graph, const std::function<bool(Index)>& is_divided);

/// Makes all faces quads: each odd face that is left is joined to the nearest other one, or to the
/// boundary, by splitting the quads along the cheapest way between them. The way may turn in a
/// quad, which is divided in three then.
/// \pre no face has more than five sides
/// \return ways made
Index join_odd_faces(PolygonGraph& graph);

}  // namespace strake
