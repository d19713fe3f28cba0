#pragma once

#include <cstdint>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake::fitting {

/// The component of each vertex, named by its lowest vertex. [V]
std::vector<Index> vertex_components(const PolyMesh& mesh);

/// [V] 1: of a component whose faces are all triangles of the input, at its vertices.
std::vector<std::uint8_t> vertices_of_input(const TriMesh& mesh, const QuadMesh& quads,
                                            const std::vector<Index>& component);

}  // namespace strake::fitting
