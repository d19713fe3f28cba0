#pragma once

#include "common/core/poly_mesh.h"
#include "stages/decimate/collapse.h"

namespace strake {

/// Makes quads of pairs of triangles, as many as there may be.
///
/// A quad is convex, with angles of 8 to 172 degrees, not over a feature or boundary line, and
/// turns along its diagonal by less than 50 degrees; drawn with its shorter diagonal it is the
/// surface it was, or nearly so. Those with the best angles come first. Then pairs are divided
/// anew along ways from one triangle that is left to another, by which both find a partner. In
/// flats, where any diagonals give the same surface, what is left is divided anew
/// (redivide_faces.h).
/// \return the faces; positions and vertices are those of the surface
PolyMesh pair_triangles(const CoarseSurface& surface);

}  // namespace strake
