#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake {

/// Neighbours of every wedge within its smooth piece of surface, in compressed rows.
struct WedgeGraph {
  std::vector<Index> offsets;     ///< [W + 1] rows
  std::vector<Index> neighbours;  ///< [E] wedges
  std::vector<Index> halfedges;   ///< [E] one that joins the two wedges, in either direction

  [[nodiscard]] Index size() const { return static_cast<Index>(offsets.size()) - 1; }
};

WedgeGraph wedge_graph(const TriMesh& mesh);

}  // namespace strake
