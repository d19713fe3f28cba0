#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "stages/mesh/polygon_graph.h"

namespace strake {

/// A few neighbouring cells as one polygon.
struct Patch {
  std::vector<Index> outline;  ///< [n] darts counter-clockwise, n even and at least 4
  std::vector<Index> inner;    ///< a dart of each edge inside
};

/// Joins cells to one polygon without a node or a feature inside.
/// \param cells  a dart of each, each cell but the first beside an earlier one
/// \return nothing where they do not make such a polygon, or one with an odd number of sides
std::optional<Patch> join_cells(const PolygonGraph& graph, const std::vector<Index>& cells);

/// A way to divide a patch into quads.
struct Division {
  std::vector<std::pair<std::size_t, std::size_t>> diagonals;  ///< positions in the outline
  double gain = 0;  ///< by how much shape and valences get better
};

/// The division of a patch into quads by diagonals that has the best shapes and valences.
/// \return nothing where every division has a reflex corner, a double edge or a vertex of valence 2
std::optional<Division> best_division(const PolygonGraph& graph, const Patch& patch);

/// Replaces the edges inside a patch by the diagonals of a division.
void divide(PolygonGraph& graph, const Patch& patch, const Division& division);

}  // namespace strake
