#pragma once

#include "stages/mesh/edge_heights.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

struct PartitionCounts {
  Index diagonals = 0;
  Index moved_nodes = 0;    ///< T-joints moved onto the line they lie on
  Index centred_faces = 0;  ///< faces divided from a new node in their middle
};

/// Divides cells until each visits a node only once, has at most `max_sides` sides and is convex
/// ([MK04] section 5.2).
///
/// The score of a diagonal favours right angles in both parts. A corner that is only slightly
/// reflex, as T-joints are, is moved into line instead of dividing its face.
/// \param heights  over the mesh, which new edges should be near (see OffSurface); may be
/// nullptr
PartitionCounts partition(PolygonGraph& graph, Index max_sides,
                          const EdgeHeights* heights = nullptr);

}  // namespace strake
