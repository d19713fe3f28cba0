#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Number of feature and boundary edges at each vertex. [V]
std::vector<Index> barrier_degrees(const TriMesh& mesh);

/// Sets the feature flag on both sides of an inner edge.
inline void set_feature(TriMesh& mesh, Index h, bool value) {
  mesh.is_feature[h] = mesh.is_feature[mesh.twin[h]] = value ? 1 : 0;
}

/// Fills `is_corner` as `find_features` states. \return number of corners
Index find_corners(TriMesh& mesh);

}  // namespace strake::import
