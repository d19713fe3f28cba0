#pragma once

#include <optional>

#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct RefineOptions {
  std::optional<Length> tolerance;       ///< divide cells that are farther from the surface
  std::optional<std::int64_t> vertices;  ///< divide the worst cells until there are as many
  std::optional<std::int64_t> sides;     ///< most corners that a face may get; 5
  std::int64_t rounds = 16;
  bool partly = false;  ///< hand on a result that is not within the tolerance yet

  OptionList declare();
};

struct RefineResult {
  QuadMesh quads;
  Report report;
};

/// Divides cells that are too far from the surface, and only those.
///
/// Beyond [MK04]. A cell is cut across the direction in which the surface bends away from it more;
/// new vertices lie on the surface, on feature and boundary lines where the edge does. The cells
/// around get a corner more, or are divided too where they have too many. Measured and divided
/// again until all cells are within the tolerance by `check_tolerance`, which no place escapes; or
/// until the wanted number of vertices is reached. Where dividing does not reach a tolerance faces
/// of the input take the place of cells (inlays.h). Faces that cross once it is reached are made
/// anew (refill_crossing.h), or likewise replaced, where it allows that.
/// \pre `quads` was made from `mesh`
/// \return the same surface topology; deterministic for any thread count
/// \throw ToleranceError naming places where the tolerance is not reached, unless `partly` is set
RefineResult refine_cells(const TriMesh& mesh, const QuadMesh& quads, const RefineOptions& options,
                          Observer& observer);

}  // namespace strake
