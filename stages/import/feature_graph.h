#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Number of feature and boundary edges at each vertex. [V]
std::vector<Index> barrier_degrees(const TriMesh& mesh);

/// Fills `is_corner` as `find_features` states. \return number of corners
Index find_corners(TriMesh& mesh);

}  // namespace strake::import
