#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "stages/mesh/edge_heights.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

/// A few neighbouring cells as one polygon.
struct Patch {
  DartLoop outline;  ///< [n] darts counter-clockwise, n even and at least 4
  DartLoop inner;    ///< a dart of each edge inside
};

/// Joins cells to one polygon without a node or a feature inside.
/// \param cells  a dart of each, each cell but the first beside an earlier one
/// \return nothing where they do not make such a polygon, or one with an odd number of sides
std::optional<Patch> join_cells(const PolygonGraph& graph, const std::vector<Index>& cells);

/// What it costs that so many edges leave from(dart), beside shape penalties (see shape_penalty).
using DegreePenalty = std::function<double(Index dart, Index degree)>;

/// A way to divide a patch into quads.
struct Division {
  std::vector<std::pair<std::size_t, std::size_t>> diagonals;  ///< positions in the outline
  double shape_gain = 0;   ///< by how much faces get better shaped, and edges nearer to the surface
  double degree_gain = 0;  ///< likewise, the degrees of the nodes
};

/// The division of a patch into quads by diagonals that has the best shapes and degrees.
/// \param worst    no face has a larger penalty than this
/// \param heights  over the mesh, which edges should be near (see OffSurface); may be nullptr
/// \return nothing where every division has a reflex corner, a double edge or a vertex of valence 2
std::optional<Division> best_division(const PolygonGraph& graph, const Patch& patch,
                                      const DegreePenalty& penalty, double worst,
                                      const EdgeHeights* heights = nullptr);

/// Replaces the edges inside a patch by the diagonals of a division.
void divide(PolygonGraph& graph, const Patch& patch, const Division& division);

}  // namespace strake
