#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "stages/refine/surface_points.h"

namespace strake {

/// Where faces of a result cross although the input does not, takes the input's own faces
/// (inlays.h) and makes quads of pairs of them. Nothing new is farther from the surface than the
/// farthest place that is sampled of the result. \param mesh, points  the input; `quads` was made
/// from it \return number of faces that cross no more; 0: `quads` is as it was. \post the same
/// topology;
///         attributes are not carried over
Index uncross(const TriMesh& mesh, const SurfacePoints& points, CrossingPlaces& crossing,
              QuadMesh& quads);

}  // namespace strake
