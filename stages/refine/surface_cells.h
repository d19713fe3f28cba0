#pragma once

#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Finds vertices of a result by the distance of their feet over the surface.
///
/// Unlike the nearest cell in space they do not lie across a fold. Distances are measured along
/// mesh edges, and straight within a face and its neighbours.
class NearestOnSurface {
 public:
  /// \param mesh  kept by reference
  NearestOnSurface(const TriMesh& mesh, const QuadMesh& quads);

  /// The vertex of the result nearest to a place of a face; kNone where the piece of surface has
  /// none.
  [[nodiscard]] Index vertex(Index face, const Vec3& place) const;

 private:
  const TriMesh& mesh_;
  std::vector<Vec3> feet_;              ///< [V of the result]
  std::vector<Index> nearest_;          ///< [V of the mesh] vertex of the result
  std::vector<double> distance_;        ///< [V of the mesh] to its foot
  std::vector<std::vector<Index>> in_;  ///< [F] vertices of the result with a foot there
};

}  // namespace strake
