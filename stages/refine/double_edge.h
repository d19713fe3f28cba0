#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/geometry/poly_topology/poly_edges.h"

namespace strake {

/// Whether no edge inside a face joins vertices that have an edge already.
/// \param triangles  that the face is cut into
/// \param edges      of the mesh
bool adds_no_double_edge(std::span<const Index> face,
                         const std::vector<std::array<Index, 3>>& triangles,
                         const PolyEdges& edges);

}  // namespace strake
