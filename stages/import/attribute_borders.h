#pragma once

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Whether faces of different labels meet at an inner edge.
bool is_label_border(const TriMesh& mesh, Index halfedge);

/// Whether the two sides of an inner edge differ in texture coordinates, by more than 1e-6.
bool is_seam(const TriMesh& mesh, Index halfedge);

}  // namespace strake::import
