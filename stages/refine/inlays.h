#pragma once

#include <cstddef>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/crossing_places.h"

namespace strake {

// Faces of the input in place of cells that lines and dividing do not make good. Beyond [MK04].
//
// Around each place a patch of cells goes, and what of the input lies over it takes its place
// (inlay.h), with bands of triangles between. Where that does not help the patch grows. At last
// vertices go that the tolerance does not need (thin_out.h).

/// How far inlays may grow.
struct InlayLimits {
  std::size_t cells;  ///< in place of which one may be, at most
  int rounds;         ///< times that they grow, at most
  /// Bad cells up to which any are made: where there are more, it is not for single places.
  std::size_t places = 3000;
};
inline constexpr InlayLimits kInlaysWithin = {4000, 16};
inline constexpr InlayLimits kInlaysUncrossed = {1000, 16};

/// Brings a result within the tolerance.
/// \param excess    what is beyond, not empty
/// \param crossing  inlays are not thinned out so far that their faces cross others
/// \return whether it could be; else `quads` is as it was. \post the same topology; attributes are
///         not carried over
bool inlay_beyond(ToleranceProof& proof, const std::vector<Excess>& excess,
                  CrossingPlaces& crossing, QuadMesh& quads,
                  const InlayLimits& limits = kInlaysWithin);

/// Makes faces fewer that cross others although the input does not, where that can be done within
/// the tolerance.
/// \param thinned_by  distance by which inlays are thinned out, at most the tolerance
/// \return [V of `quads`] 1: of a face of an inlay; empty: it is as it was.
/// \pre all of `quads` is within the tolerance. \post likewise, and as for `inlay_beyond`
std::vector<char> inlay_crossing(ToleranceProof& proof, CrossingPlaces& crossing, double thinned_by,
                                 QuadMesh& quads, const InlayLimits& limits = kInlaysUncrossed);

}  // namespace strake
