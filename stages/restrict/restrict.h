#pragma once

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// A field on the coarser mesh of a mesh: at each wedge what it is at the wedge it was made from.
/// Confidences of faces are the means of those of their wedges.
/// \pre coarse.parent_id == field.mesh_id
/// \throw UsageError where the field follows guides, whose places are on the finer mesh
PrincipalField restrict_field(const TriMesh& coarse, const PrincipalField& field);

}  // namespace strake
