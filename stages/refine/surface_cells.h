#pragma once

#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// [V of the mesh] the vertex of the result whose foot is nearest on the surface, measured along
/// mesh edges; kNone where the piece of surface has none. Unlike the nearest cell in space it is
/// not one that lies across a fold.
std::vector<Index> nearest_on_surface(const TriMesh& mesh, const QuadMesh& quads);

}  // namespace strake
