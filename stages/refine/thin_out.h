#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Takes vertices out of connected triangles, each merged into a neighbour, as long as all that
/// went are within a distance of what is left (OpenMesh's quadrics and Hausdorff distance), and
/// turns edges where that makes better triangles.
/// \param positions  [V] any length unit
/// \param stays      [V] 1: vertices that stay, with the edges between them. So do those on the
///                   outline, and no edge is made between two of these
/// \param distance   in the unit of positions, positive
/// \return the triangles that are left; all as they are where they are no manifold
std::vector<std::array<Index, 3>> thin_out(const std::vector<Vec3>& positions,
                                           const std::vector<std::array<Index, 3>>& triangles,
                                           const std::vector<std::uint8_t>& stays, double distance);

}  // namespace strake
