#pragma once

#include "common/core/observer.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct UncrossResult {
  QuadMesh quads;
  Report report;
};

/// Where faces of a result cross although the input does not, takes the input's own faces
/// (inlays.h), thinned out, and makes quads of pairs of them. Beyond [MK04].
///
/// Nothing new is farther from the surface than the farthest place that is sampled of the result.
/// Where nothing helps the result stays as it is.
/// \pre `quads` was made from `mesh`
/// \return the same surface topology, and fewer faces that cross if anything was changed;
///         deterministic for any thread count
UncrossResult uncross_faces(const TriMesh& mesh, const QuadMesh& quads, Observer& observer);

}  // namespace strake
