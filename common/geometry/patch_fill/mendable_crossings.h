#pragma once

#include <array>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"

namespace strake {

/// The pairs of faces that cross with the vertices at these places, the smaller face first,
/// ascending. None where more than a tenth of the faces cross, in more than a hundred pairs, or
/// in more than 5000: sheets on top of each other, or details smaller than the faces, that no
/// change of single faces mends.
/// \param positions  [V]
std::vector<std::array<Index, 2>> mendable_crossings(const PolyMesh& mesh,
                                                     const std::vector<Vec3>& positions);

}  // namespace strake
