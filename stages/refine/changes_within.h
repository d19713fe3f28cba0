#pragma once

#include <memory>

#include "common/core/poly_mesh.h"
#include "common/geometry/cell_error/compared_surfaces.h"
#include "stages/refine/surface_points.h"

namespace strake {

// Changes of a result of `input` that check_tolerance proves to be within a tolerance, and that
// stays so. Vertices stay where they are.

/// Makes faces that cross others anew (refill_crossing.h) where the tolerance allows it.
void refill_within(const std::shared_ptr<const InputSurface>& input, double tolerance,
                   QuadMesh& quads);

/// Makes quads of odd faces near each other (redivide_faces.h), which dividing leaves, where the
/// tolerance allows it and no faces come to cross. Edges along feature and boundary lines stay.
/// \param points  of the input
void pair_odd_cells_within(const std::shared_ptr<const InputSurface>& input,
                           const SurfacePoints& points, double tolerance, QuadMesh& quads);

/// Makes triangles of the cells that others could cut otherwise (see cells_in_doubt): those by
/// which it was proven. A cell stays where an edge of theirs would be double.
void cut_cells_in_doubt(const std::shared_ptr<const InputSurface>& input, double tolerance,
                        QuadMesh& quads);

}  // namespace strake
