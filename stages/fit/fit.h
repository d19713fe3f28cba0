#pragma once

#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct FitOptions {
  std::int64_t rounds = 3;

  OptionList declare();
};

struct FitResult {
  QuadMesh quads;
  Report report;
};

/// Moves vertices along the surface normal so that the faces between them, which cut off what bends
/// away from them, lie on both sides of the surface instead of on one.
///
/// Beyond [MK04], whose vertices stay on the surface. Least squares over sample points of the
/// faces: sum of area * (distance along the normal of the nearest surface point)^2, one unknown
/// per vertex, solved and measured again `rounds` times. Vertices on feature and boundary lines
/// stay. A vertex around which the distance grew, or a face became concave, goes back, so that the
/// sum never grows.
/// \pre `quads` was made from `mesh`
/// \return the same faces and provenance; deterministic for any thread count
/// Cost O(faces of the result * log faces of the mesh) per round.
FitResult fit_vertices(const TriMesh& mesh, const QuadMesh& quads, const FitOptions& options,
                       Observer& observer);

}  // namespace strake
