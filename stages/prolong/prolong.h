#pragma once

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// A field of a coarser mesh on the mesh that it was made from.
///
/// At wedges that the coarser mesh has, too, the field stays as it is. At others curvature tensors,
/// crosses and confidences are interpolated within the coarser face that is nearest of those that
/// face the same way, about. Confidences of faces are the means of those of their wedges.
/// \pre coarse.parent_id == mesh.id, field.mesh_id == coarse.id
/// \throw UsageError where the field follows guides, whose places are on the coarser mesh
/// Cost O(W log F). Deterministic for any thread count.
PrincipalField prolong_field(const TriMesh& mesh, const TriMesh& coarse,
                             const PrincipalField& field);

}  // namespace strake
