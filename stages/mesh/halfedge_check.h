#pragma once

#include <string>

#include "common/core/poly_mesh.h"

namespace strake {

/// Builds the half-edge structure of a polygon mesh ([MK04] section 5.1) in OpenMesh, which refuses
/// faces that would make an edge or vertex non-manifold: a second opinion, by other code, on what
/// the cells of the line graph should be by construction.
/// \return what is wrong, with the first face; "" where the mesh is an oriented manifold
std::string halfedge_defect(const PolyMesh& mesh);

}  // namespace strake
