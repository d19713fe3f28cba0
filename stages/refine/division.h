#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/core/observer.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "stages/refine/cells_beyond.h"
#include "stages/refine/inlays.h"
#include "stages/refine/refinement.h"

namespace strake {

/// How cells are divided for a tolerance.
struct DivisionOptions {
  std::int64_t rounds = 16;
  bool partly = false;  ///< the result may miss the tolerance
  /// Cells stay as they are where dividing them would make faces cross, or concave.
  bool without_faults = false;
  /// Vertices from which on it takes too many.
  std::int64_t most_vertices = std::numeric_limits<std::int64_t>::max();
};

/// How far dividing cells comes.
struct Divided {
  std::int64_t rounds = 0;
  std::vector<Excess> left;  ///< places beyond the tolerance; none: it is reached
};

/// Divides cells until all are within the tolerance, or there are too many. Where that ends in vain
/// the result is the one with the fewest places beyond, or the last one where it may miss it.
Divided divide_until_within(ToleranceProof& proof, Refinement& refinement,
                            const DivisionOptions& options, Observer& observer);

/// Brings what dividing has left within the tolerance. \return whether it could be
bool inlay_left(ToleranceProof& proof, Refinement& refinement, const std::vector<Excess>& left,
                Observer& observer, const InlayLimits& limits = kInlaysWithin);

/// Divides the first cells, leaving out those around which faces come to cross that did not before,
/// or to be concave.
/// \return whether any is left to be divided
bool divide_without_faults(Refinement& refinement, const ComparedSurfaces& surfaces,
                           std::vector<Target> targets, std::size_t wanted, double tolerance);

}  // namespace strake
