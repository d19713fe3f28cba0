#pragma once

#include <Eigen/Geometry>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/surface_point.h"

namespace strake {

/// Faces of a surface, divided where they are large.
struct SurfacePart {
  std::vector<SurfacePoint> points;  ///< [V] of the surface
  std::vector<Vec3> positions;       ///< [V] relative to its origin
  std::vector<std::array<Index, 3>> faces;
  std::vector<Index> parent;                     ///< [F] face of the surface
  std::vector<std::array<Index, 3>> neighbours;  ///< [F] across the side from corner i; kNone: none
  /// Sides of faces on the boundary of the surface, from corner to corner.
  std::set<std::pair<Index, Index>> boundary;
};

/// The part of a surface that is joined to some of its faces and may reach into a box, with what it
/// encloses, also against the boundary. In the box the longest edges are halved until none is
/// longer than `longest`.
/// \param faces    of the surface
/// \param longest  model units, positive
/// \return nothing in it where it would have more than `most` faces
SurfacePart surface_part(const TriMesh& mesh, const std::vector<Index>& faces,
                         const Eigen::AlignedBox3d& box, double longest, std::size_t most);

}  // namespace strake
