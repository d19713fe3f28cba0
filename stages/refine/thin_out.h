#pragma once

#include <array>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Takes vertices out of connected triangles, each merged into a neighbour, as long as all that
/// went are within a distance of what is left (OpenMesh's quadrics and Hausdorff distance), and
/// turns edges where that makes better triangles.
/// \param positions  [V] any length unit
/// \param distance   [V] around a vertex, in that unit; 0: it stays, with the edges to others that
///                   do. So do those on the outline, and no edge is made between two of these
/// \return the triangles that are left; all as they are where they are no manifold
std::vector<std::array<Index, 3>> thin_out(const std::vector<Vec3>& positions,
                                           const std::vector<std::array<Index, 3>>& triangles,
                                           const std::vector<double>& distance);

}  // namespace strake
