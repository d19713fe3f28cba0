#pragma once

#include "common/core/poly_mesh.h"

namespace strake {

/// Merges vertices of a face that are at the same place: neighbours, or opposite each other in a
/// quad that is folded onto itself, which then goes. The older of two stays. What would be no
/// surface any more stays apart, and so does the boundary.
/// \pre an oriented 2-manifold without attributes
/// \return number of vertices that went. \post the same topology
Index merge_places(QuadMesh& quads);

}  // namespace strake
