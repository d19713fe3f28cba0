#pragma once

#include <vector>

#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Takes nodes out of components whose cells are triangles of the surface, each time the one that
/// is missed least, until they have as many cells as lines would make.
///
/// A node is merged into a neighbour. Least is the sum of squared distances of the neighbour from
/// the planes of all cells that were around either, weighted by area, and from planes upright on
/// feature and boundary edges (Garland & Heckbert 1997). Topology, features and corners stay.
/// \param component  [F] of the surface
/// \param cells      [components] wanted, as quads; infinite: the component stays as it is
/// \return number of nodes taken out. Cost O(N log N)
Index simplify_small_components(PolygonGraph& graph, const std::vector<Index>& component,
                                const std::vector<double>& cells);

}  // namespace strake
