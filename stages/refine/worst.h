#pragma once

#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct WorstOptions {
  /// Vertices that may be added, as a share of those there are; 0: the result stays as it is.
  double share = 0.03;

  OptionList declare();
};

struct WorstResult {
  QuadMesh quads;
  Report report;
};

/// Brings the places of a result that are farthest from the surface nearer to it, where few
/// vertices do. Beyond [MK04].
///
/// Cells there are divided and inlaid as for a tolerance (refine.h), which is a share of the
/// largest distance: the smallest of a few that take no more vertices than may be added, after
/// which no more faces cross, are odd, concave or thin, and the root mean square of the distance is
/// no larger.
/// \pre `quads` was made from `mesh`
/// \return the same surface topology; `quads` where nothing is better; deterministic for any thread
///         count
WorstResult bring_worst_nearer(const TriMesh& mesh, const QuadMesh& quads,
                               const WorstOptions& options, Observer& observer);

}  // namespace strake
