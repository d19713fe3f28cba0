#pragma once

#include <memory>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {

/// Finds where faces of results cross although the surface does not.
class CrossingPlaces {
 public:
  /// \param mesh  the input, kept by reference
  explicit CrossingPlaces(const TriMesh& mesh) : mesh_(mesh) {}

  /// The faces that cross others, ascending, but for pairs within reach of which, of either face,
  /// the input crosses itself.
  std::vector<Index> faces_of(const PolyMesh& result);
  /// The middles of these faces, relative to the mesh's origin.
  std::vector<Vec3> of(const PolyMesh& result);

 private:
  /// Whether the input crosses itself nearer to a place than `reach`.
  bool is_crossed_by_itself(const Vec3& place, double reach);

  const TriMesh& mesh_;
  bool is_known_ = false;                       ///< whether `own_` is
  std::vector<std::array<Index, 3>> crossing_;  ///< the faces of the input that cross
  std::unique_ptr<SurfaceDistance> own_;        ///< of those; nullptr: none
};

}  // namespace strake
