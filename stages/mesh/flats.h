#pragma once

#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Splits feature and boundary edges that cross others of a flat part of the surface now that they
/// are straight, which brings them nearer to their course.
/// \return edges split
Index split_crossing_features(PolygonGraph& graph);

/// Draws edges in flat parts of the surface anew where they cross or turn cells over.
///
/// Lines run around what is in their way, such as a hole or a letter on a plate; the straight edges
/// that become of them may not, where cells are larger than that. They are taken out, and triangles
/// without further nodes fill the gap. Beyond [MK04].
/// \return parts with new edges
/// Cost: O(n log n) for n edges in flats, and that of the triangulations.
Index redraw_flats(PolygonGraph& graph);

}  // namespace strake
