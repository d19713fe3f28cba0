#pragma once

#include <cstdint>

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Faces of a mesh that pass through each other.
struct OwnCrossings {
  std::int64_t pairs = 0;
  Vec3 place = Vec3::Zero();  ///< where the deepest pair is, relative to the mesh's origin
};

/// Finds them. Faces that only touch, as sheets do along an edge that they had in common and
/// sides of solids against each other, are none.
/// Cost O(F log F), parallel.
OwnCrossings find_own_crossings(const TriMesh& mesh);

}  // namespace strake::import
