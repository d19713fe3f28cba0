#pragma once

#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {

/// Makes faces that cross others anew, together with those around where that is needed.
///
/// Where lines lie across a tip or a fold, cells lie in each other, and neither moving nor dividing
/// them helps. The faces of pairs that cross each other, or these and one or two rings around, are
/// taken out, up to feature and boundary lines; the vertices inside go, and the outline is filled
/// with triangles (fill_polygon.h), two of which become a quad where its shape allows it. Where
/// faces cross even so, the same is tried across such lines, with corners kept, and then without.
/// Taken is the first after which nothing crosses, or the one that leaves the fewest pairs; none of
/// its faces looks inside that did not before. The rest of the mesh stays as it is, and so do
/// meshes in which too many faces cross (mendable_crossings.h).
/// \param mesh, surface  what `quads` was made from
/// \param reach  model units: new faces are at most so far from the surface, and what was taken
///               out from them, in samples
/// \param spared  places, relative to the mesh's origin, around which nothing is made anew
/// \return number of faces taken out; 0: `quads` is as it was. \post the same topology, and fewer
/// pairs of crossing faces, if any was; attributes are not carried over
Index refill_crossing_faces(const TriMesh& mesh, const SurfaceDistance& surface, QuadMesh& quads,
                            double reach, const std::vector<Vec3>& spared = {});

}  // namespace strake
