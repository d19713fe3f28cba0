#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Unit normals of the faces. Those of slivers (height below 1/50 of the longest edge) so low that
/// rounding of the coordinates to single precision could turn them are replaced by the normal of a
/// neighbour, across one of the sliver's long edges where possible. Zero where a whole component
/// consists of slivers.
std::vector<Vec3> robust_face_normals(const TriMesh& mesh);

}  // namespace strake::import
