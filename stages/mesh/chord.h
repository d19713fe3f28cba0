#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Wanted length of an edge, model units.
using EdgeLength = std::function<double(Index dart)>;

/// A straight way through quads from one odd face (of three or five sides) to another or to the
/// boundary.
struct Chord {
  /// Edges crossed, in order; each dart has the cell that is left on its left.
  std::vector<Index> rungs;
  bool ends_outside = false;  ///< the last rung is a boundary edge
};

/// Follows the way out of an odd face across one of its edges.
/// \param most  longest way, in rungs
/// \return nothing where it crosses itself, is too long or ends at a larger face
std::optional<Chord> follow_chord(const PolygonGraph& graph, Index dart, std::size_t most);

/// By how much shape and size of the faces gain when the strip along the chord is split in two:
/// lines that end in pentagons are prolonged. Minus infinity where a face would become concave.
double split_gain(const PolygonGraph& graph, const Chord& chord, const EdgeLength& wanted);
void split_strip(PolygonGraph& graph, const Chord& chord);

/// As split_gain for taking the strip out: the lines on both sides of it become one.
double collapse_gain(const PolygonGraph& graph, const Chord& chord, const EdgeLength& wanted);
/// \return rungs contracted; fewer than there are where one would change the topology. The faces
/// stay a sound mesh then, too.
std::size_t collapse_strip(PolygonGraph& graph, const Chord& chord);

}  // namespace strake
