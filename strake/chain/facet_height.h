#pragma once

#include <optional>

#include "common/core/options.h"
#include "common/core/poly_mesh.h"

namespace strake {

/// Height above which edges between facets of a coarse mesh are to be features where a count is
/// wanted: a share of the cells, small where there are many more than the mesh has vertices.
/// Nothing where there are about as many or fewer.
///
/// \param diagonal  of the mesh, model units
/// \param wanted    vertices of the result
std::optional<Length> facet_height(const PolyMesh& mesh, double diagonal, double wanted);

}  // namespace strake
