#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "stages/mesh/claimed_nodes.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Wanted length of an edge, model units.
using EdgeLength = std::function<double(Index dart)>;

/// Quads in a row, a straight way through them: from one odd face (of three or five sides) or the
/// boundary to another, or back to its start.
struct Strip {
  /// Edges crossed, in order; each dart has the cell that is left on its left.
  std::vector<Index> rungs;
  bool starts_outside = false;  ///< the first rung is a boundary edge
  bool ends_outside = false;    ///< the last one is
  bool is_closed = false;       ///< the last quad is left across the first rung
};

/// Follows the way out of a cell, or of what is outside, across one of its edges.
/// \param most     longest way, in rungs
/// \param crossed  [E] gets 1 for the edges crossed, whatever comes of it; nullptr: not asked
/// \return nothing where it crosses itself, is too long, ends at a larger face, or starts in a quad
///         and does not come back
std::optional<Strip> follow_strip(const PolygonGraph& graph, Index dart, std::size_t most,
                                  std::vector<char>* crossed = nullptr);

/// Whether an edge can be halved and its middle joined to the corners across from it in the two odd
/// faces beside it: not where both are pentagons with the same corner there.
bool can_halve(const PolygonGraph& graph, Index dart);

/// Price of splitting a strip lengthwise in two: the higher, the narrower it is against the wanted
/// length of its rungs. At least 0, about 0.3 for each rung of that length.
double split_price(const PolygonGraph& graph, const Strip& strip, const EdgeLength& wanted);
/// By how much the shapes of faces gain by it (see shape_penalty): lines that end in pentagons are
/// prolonged. Minus infinity where a face would become concave.
double split_gain(const PolygonGraph& graph, const Strip& strip);
void split_strip(PolygonGraph& graph, const Strip& strip);

/// As for splitting, for taking a strip out: the lines on both sides of it become one. The price is
/// the higher, the wider it is; about 0.6 for each rung of the wanted length.
double collapse_price(const PolygonGraph& graph, const Strip& strip, const EdgeLength& wanted);
double collapse_gain(const PolygonGraph& graph, const Strip& strip);
/// \return rungs contracted; fewer than there are where one would change the topology. The faces
/// stay a sound mesh then, too.
std::size_t collapse_strip(PolygonGraph& graph, const Strip& strip);

/// Takes the corners of the cells of a strip, or of all cells at its rungs.
/// \return false where one has been taken before
bool claim_strip(const PolygonGraph& graph, const Strip& strip, bool all, ClaimedNodes& claimed);

}  // namespace strake
