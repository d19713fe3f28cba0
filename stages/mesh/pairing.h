#pragma once

#include "stages/mesh/edge_heights.h"
#include "stages/mesh/polygon_graph.h"
#include "stages/mesh/strip.h"

namespace strake {

/// What `pair_odd_faces` did.
struct PairingCounts {
  Index divided_patches = 0;   ///< neighbouring odd faces made into quads
  Index split_strips = 0;      ///< lines prolonged from one odd face to another
  Index collapsed_strips = 0;  ///< pieces of lines taken back
};

/// Makes faces of three and five sides into quads, two at a time: neighbours are divided anew; ones
/// farther apart are joined by splitting the strip of quads between them, or by taking it out.
///
/// A change is made where the gain in shape and regularity outweighs the distance of the strip's
/// width from the wanted one.
/// \pre faces are convex; they stay so
/// \param wanted   wanted length of an edge
/// \param price    what a face that is no quad costs, beside shape penalties (see shape_penalty); 0
///                 changes nothing
/// \param heights  over the mesh, which edges should be near (see OffSurface); may be nullptr
PairingCounts pair_odd_faces(PolygonGraph& graph, const EdgeLength& wanted, double price,
                             const EdgeHeights* heights = nullptr);

}  // namespace strake
