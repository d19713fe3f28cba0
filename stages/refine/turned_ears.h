#pragma once

#include "common/core/poly_mesh.h"
#include "stages/refine/surface_points.h"

namespace strake {

/// Takes cells away that lie across notches of the boundary: turned over against the surface under
/// their corners, or without area, and joined to others by one edge only. That edge stands for the
/// notch then. Dividing such a cell instead would put vertices over and over where the boundary is.
/// \param points  of the input
/// \pre without attributes \post the same topology
void drop_turned_ears(const SurfacePoints& points, QuadMesh& quads);

}  // namespace strake
