#pragma once

#include <utility>
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

  /// The vertex of the result nearest to a place of a face, of several the first; kNone where the
  /// piece of surface has none. Cost that of the surface up to there; may be called in parallel.
  [[nodiscard]] Index vertex(Index face, const Vec3& place) const;

 private:
  const TriMesh& mesh_;
  std::vector<Vec3> feet_;  ///< [V of the result]
  std::vector<std::pair<Index, Index>>
      by_face_;  ///< face and vertex of the result there, ascending
};

}  // namespace strake
