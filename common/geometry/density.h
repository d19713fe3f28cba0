#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// [W] the wanted density at each wedge, of a field that goes by the vertices of the file read.
/// \throw PreconditionError where that file had more vertices than the field has, or most of these
///        lie elsewhere, or the mesh does not say which of them it has; InputError where a density
///        is no positive number
std::vector<double> density_at_wedges(const TriMesh& mesh, const DensityField& density);

}  // namespace strake
