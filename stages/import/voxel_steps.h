#pragma once

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Whether a surface is that of a volume of zeros and ones, as of a segmented scan or of heights in
/// whole steps: along each axis its vertices lie in layers that are evenly apart, and in nearly all
/// of them, and it is bent by steps up and down. These are steps of the grid, and not of the shape.
///
/// Of isosurfaces of grey values, and of parts, vertices lie anywhere along an axis, or in few
/// places; a box that is divided evenly has no steps.
/// \pre `build_topology` has run. Cost O(n log n)
bool has_voxel_steps(const TriMesh& mesh);

}  // namespace strake::import
