#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Puts a vertex on tips of cones. Lines run together there and end, and their cells cut tips off.
///
/// A corner of the cell over the tip is moved, or the cell gets a vertex from which edges run to
/// every other corner: whichever leaves faces nearer to the surface. Neither happens where faces as
/// large as cells do not follow the cone, as at thorns.
/// \param may_add  whether cells may get a vertex, which leaves triangles
/// \pre `quads` was made from `mesh`, and is a manifold
/// \return number of tips that have one
Index meet_sharp_points(const TriMesh& mesh, bool may_add, QuadMesh& quads);

}  // namespace strake
