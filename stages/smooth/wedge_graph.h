#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake {

/// Neighbours of every wedge within its smooth piece of surface, in compressed rows.
struct WedgeGraph {
  std::vector<Index> offsets;     ///< [W + 1] rows
  std::vector<Index> neighbours;  ///< [E] wedges

  [[nodiscard]] Index size() const { return static_cast<Index>(offsets.size()) - 1; }
};

WedgeGraph wedge_graph(const TriMesh& mesh);

/// [E] A half-edge that joins each wedge of the graph and its neighbour, in either direction.
std::vector<Index> graph_halfedges(const TriMesh& mesh, const WedgeGraph& graph);

}  // namespace strake
