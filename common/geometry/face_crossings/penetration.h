#pragma once

#include <array>

#include "common/core/types.h"
#include "common/geometry/face_crossings/placed_face.h"

namespace strake {

/// How deep two triangles that cross pass through each other: the length of the shortest shift that
/// parts them, but for rounding. 0 where they only touch, as sheets along a common edge do. Of
/// triangles in one plane, but for a degree, the shift is along it: those on top of each other are
/// folded over, however thin they are together.
/// \pre both have an area
double penetration_depth(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// The depth of those of their triangles that cross deepest; 0 where none do.
double penetration_depth(const PlacedFace& a, const PlacedFace& b);

}  // namespace strake
