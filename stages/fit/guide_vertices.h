#pragma once

#include <optional>
#include <vector>

#include "common/core/guides.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake::fitting {

/// The ways from the feet of vertices to the guide lines that they are beside: those of lines that
/// were traced along a guide, and of lines that cross it there.
/// \param guides  on the mesh
/// \return [V of the result] nothing: it is beside none
std::vector<std::optional<Vec3>> ways_to_guides(const TriMesh& mesh, const QuadMesh& quads,
                                                const LaidGuides& guides);

}  // namespace strake::fitting
