#pragma once

#include <span>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"

namespace strake {

/// The faces around each vertex of a polygon mesh, whatever its defects.
class VertexFaces {
 public:
  /// \param mesh  kept by reference; its faces may not change
  /// \pre all corners are vertices of the mesh
  /// Cost O(V + C).
  explicit VertexFaces(const PolyMesh& mesh);

  /// The corners at a vertex, ascending.
  [[nodiscard]] std::span<const Index> corners(Index vertex) const {
    return of_vertex(corners_, vertex);
  }
  /// The faces that these corners are of: ascending, one as often as it names the vertex.
  [[nodiscard]] std::span<const Index> faces(Index vertex) const {
    return of_vertex(faces_, vertex);
  }
  /// The vertices beside a vertex in its faces, ascending, each once.
  [[nodiscard]] std::vector<Index> neighbours(Index vertex) const;
  /// The face with a side from one vertex to another, of several the last; kNone where none has it.
  [[nodiscard]] Index face_with_side(Index from, Index to) const;

 private:
  [[nodiscard]] std::span<const Index> of_vertex(const std::vector<Index>& rows, Index v) const {
    return {rows.data() + offsets_[v], static_cast<std::size_t>(offsets_[v + 1] - offsets_[v])};
  }

  const PolyMesh& mesh_;
  std::vector<Index> offsets_;  ///< [V + 1] into the two below
  std::vector<Index> corners_;  ///< [C] grouped by vertex
  std::vector<Index> faces_;    ///< [C] of each of these corners
};

}  // namespace strake
