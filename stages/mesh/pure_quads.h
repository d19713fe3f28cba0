#pragma once

#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Makes all faces quads: each odd face that is left is joined to the nearest other one, or to the
/// boundary, by splitting the quads along the cheapest way between them. The way may turn in a
/// quad, which is divided in three then.
/// \pre no face has more than five sides
/// \return ways made
Index join_odd_faces(PolygonGraph& graph);

}  // namespace strake
