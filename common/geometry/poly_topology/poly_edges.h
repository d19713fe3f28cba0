#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"

namespace strake {

/// The undirected edges of a polygon mesh, whatever its defects.
///
/// A *side* is one face's use of an edge, named by the corner it starts at: side c runs from
/// corners[c] to the next corner of the same face. A side between equal vertices is no edge.
struct PolyEdges {
  std::vector<std::array<Index, 2>> vertices;  ///< [E] smaller index first, ascending
  std::vector<Index> side_offsets = {0};       ///< [E + 1] into `sides`
  std::vector<Index> sides;                    ///< grouped by edge, ascending within one
  std::vector<Index> corner_face;              ///< [C] face of each corner

  [[nodiscard]] Index edge_count() const { return static_cast<Index>(vertices.size()); }
  [[nodiscard]] std::span<const Index> sides_of(Index edge) const {
    return {sides.data() + side_offsets[edge],
            static_cast<std::size_t>(side_offsets[edge + 1] - side_offsets[edge])};
  }
};

/// The corner after `corner` in its face.
inline Index next_corner(const PolyMesh& mesh, const PolyEdges& edges, Index corner) {
  return mesh.next_corner(edges.corner_face[corner], corner);
}

/// Collects the edges of a mesh.
/// \throw PreconditionError naming the face where a corner is no vertex of the mesh
/// Cost O(C) for bounded valence.
PolyEdges collect_edges(const PolyMesh& mesh);

/// [C] The other side of each side's edge; kNone where the edge has not just two sides.
std::vector<Index> opposite_sides(const PolyEdges& edges);

}  // namespace strake
