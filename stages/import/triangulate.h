#pragma once

#include "common/core/poly_mesh.h"
#include "stages/import/soup.h"

namespace strake::import {

/// Cuts the faces of a polygon mesh into triangles; all vertices are kept.
///
/// Quads are cut along the shorter diagonal, unless that turns a triangle over or leaves one
/// without height. Larger polygons lose the ear with the largest least angle first, in the plane of
/// their Newell normal; polygons that cross themselves there are still cut into triangles with the
/// given border. Faces that cannot be used (indices out of range, non-finite corners, fewer than
/// three corners apart from repetitions) are counted and left out. Cost O(n) for triangles and
/// quads, O(n log n) as a rule for n corners.
/// \throw InputError where there are more triangles than half-edges can be numbered of
Soup triangulate(const PolyMesh& mesh, Repairs& repairs);

}  // namespace strake::import
