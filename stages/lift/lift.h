#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// A result on the mesh that the coarser one it was made from is a coarser one of.
///
/// Vertices stay where they are, and their feet become points of `mesh`: on feature and boundary
/// lines and at vertices, which both have, the same ones; elsewhere the nearest of those where the
/// surface faces the same way, about. Attributes are those of `mesh`.
/// \pre coarse.parent_id == mesh.id, quads.mesh_id == coarse.id
/// Cost O(V log F). Deterministic for any thread count.
QuadMesh lift_quads(const TriMesh& mesh, const TriMesh& coarse, const QuadMesh& quads);

}  // namespace strake
