#pragma once

#include <optional>
#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/surface_point.h"

namespace strake {

/// The faces that hold a point: one, two of an edge, or all around a vertex.
std::vector<Index> faces_around(const TriMesh& mesh, const SurfacePoint& point);

/// Where the way over the surface from a to b, in which a plane cuts it, is best divided
/// (way_split.h).
///
/// Unlike the nearest point it stays on the sheet that a and b lie on.
/// \param normal   of the surface between them, about; the plane holds a, b and this direction
/// \param longest  model units; longer ways do not count
/// \return nothing where the plane's cut does not lead from one to the other
std::optional<SurfacePoint> split_of_section(const TriMesh& mesh, const SurfacePoint& a,
                                             const SurfacePoint& b, const Vec3& normal,
                                             double longest);

}  // namespace strake
