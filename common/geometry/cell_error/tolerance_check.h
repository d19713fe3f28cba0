#pragma once

#include <vector>

#include "common/geometry/cell_error/compared_surfaces.h"

namespace strake {

/// A place of a surface that is farther from the other one than it should be.
struct Excess {
  double distance = 0;        ///< model units
  Vec3 place = Vec3::Zero();  ///< relative to the mesh's origin
  Index cell = kNone;         ///< face of the result: that of the place, or that nearest to it
  Index input_face = kNone;   ///< face of the input where the place is on the input
};

/// Finds where two surfaces are not within a tolerance of each other.
///
/// Not by samples: the distance to one triangle is convex, so where all corners of a piece are
/// within the tolerance of the same triangle of the other surface, all of the piece is. Pieces for
/// which that does not hold are halved, down to a small share of the tolerance; what is undecided
/// then counts as an excess. Faces that rounding alone decides how to split are checked in either
/// way.
/// \param tolerance  model units, positive
/// \return the worst place of each triangle, of either surface, that is not proven to be within the
///         tolerance everywhere; none where all is. Deterministic for any thread count
/// Cost O(n log n) with few pieces beyond the larger number of faces, unless much lies close to the
/// tolerance.
std::vector<Excess> check_tolerance(const ComparedSurfaces& surfaces, double tolerance);

}  // namespace strake
