#pragma once

#include "stages/mesh/edge_heights.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

/// What `regularise` did.
struct RegularisingCounts {
  Index divided_patches = 0;  ///< neighbouring quads divided anew
  Index closed_quads = 0;     ///< quads whose opposite corners were merged
};

/// How many edges a node has too many or too few. Inside the surface, on features too, it should
/// have four. 0 at corners and on boundaries, where the shape of the surface decides.
/// \param dart  one that leaves the node
Index irregularity(const PolygonGraph& graph, Index dart, Index degree);

/// Makes pairs of nodes with too many and too few edges cancel each other: two or three quads in a
/// row are divided anew, and quads are closed along a diagonal. Faces of other numbers of sides
/// stay.
///
/// A change is made where the gain in regularity and shape is positive.
/// \pre faces are convex; they stay so
/// \param price    what an edge too many or too few costs, beside shape penalties (see
///                 shape_penalty); 0 changes nothing
/// \param heights  over the mesh, which edges should be near (see OffSurface); may be nullptr
RegularisingCounts regularise(PolygonGraph& graph, double price,
                              const EdgeHeights* heights = nullptr);

}  // namespace strake
