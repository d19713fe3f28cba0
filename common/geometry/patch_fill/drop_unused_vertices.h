#pragma once

#include "common/core/poly_mesh.h"

namespace strake {

/// Takes out the vertices that are no face's, in place and provenance; the others stay in order.
/// \pre without attributes
void drop_unused_vertices(QuadMesh& quads);

}  // namespace strake
