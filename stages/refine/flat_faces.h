#pragma once

#include "common/core/poly_mesh.h"
#include "common/geometry/cell_error/tolerance_check.h"

namespace strake {

/// Takes faces without area, and sides of no length, out of a result within a tolerance, where it
/// stays a surface: merges vertices at the same place (merge_places.h), and turns the longest edges
/// of triangles whose corners are on a straight line, as bands along feature lines have them. The
/// surface stays the same, up to rounding.
/// \pre without attributes
/// \post the same topology
void mend_flat_faces_within(ToleranceProof& proof, QuadMesh& quads);

}  // namespace strake
