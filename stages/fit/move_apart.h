#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/types.h"
#include "stages/fit/face_guard.h"
#include "stages/fit/vertex_places.h"

namespace strake::fitting {

/// Moves vertices of faces that pass through others so that fewer do: a little way towards or away
/// from a neighbour, to the middle of all, or along the normal, whatever leaves the fewest pairs,
/// the shortest of these. No face gets worse than the guard allows from the places it has now on.
/// Cost: some milliseconds for each vertex of a crossing face.
/// \return number of vertices that moved; feet are not found again
Index move_apart(const PolyMesh& mesh, FaceGuard& guard, VertexPlaces& places);

}  // namespace strake::fitting
