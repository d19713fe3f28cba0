#pragma once

#include <vector>

#include "common/core/edge_list.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "stages/import/soup.h"

namespace strake::import {

/// The list with the parts of edges that got vertices inside in place of these.
EdgeList listed_parts(const EdgeList& list, const PolyMesh& input,
                      const std::vector<DividedEdge>& divided);

/// Flags the edges of a list as features. Vertices at the same place count as one, so edges are
/// found also where the repairs joined or copied vertices.
/// \param input  the polygons that the list's numbers refer to
/// \return inner edges flagged
/// \throw InputError naming the list's file, line and a remedy where there is no such vertex or
/// edge
Index flag_listed_edges(const EdgeList& list, const PolyMesh& input, TriMesh& mesh);

}  // namespace strake::import
