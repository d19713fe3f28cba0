#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/types.h"

namespace strake::fitting {

/// Divides faces that pass through others by a diagonal, where their parts pass through fewer.
///
/// Along a bent feature line two faces can have two edges in common, one after the other; where
/// both are measured and drawn with the triangle over these edges, they lie on each other there.
/// Another diagonal helps, and a face is held to it by being divided. Parts are convex, face the
/// way the face did, and have no angle below 1 degree; no vertex moves.
/// \return number of faces divided; their second parts come last in the mesh
Index divide_crossing_faces(PolyMesh& mesh);

}  // namespace strake::fitting
