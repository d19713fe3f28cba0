#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/core/types.h"
#include "common/geometry/face_crossings/box_tree.h"

namespace strake {

/// A face of a polygon mesh where it is in space.
struct PlacedFace {
  BoxTree::Box box;
  std::vector<std::array<Vec3, 3>> triangles;
};

/// \param polygon  vertices, at least 3
PlacedFace placed_face(const std::vector<Vec3>& positions, std::span<const Index> polygon);

/// Whether triangles of one cross triangles of the other (triangles_cross).
bool faces_cross(const PlacedFace& a, const PlacedFace& b);

}  // namespace strake
