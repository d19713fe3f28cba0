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
/// then counts as an excess.
/// \param tolerance  model units, positive
/// \return the worst place of each triangle, of either surface, that is not proven to be within the
///         tolerance everywhere; none where all is. Deterministic for any thread count
/// Cost O(n log n) with few pieces beyond the larger number of faces, unless much lies close to the
/// tolerance.
std::vector<Excess> check_tolerance(const ComparedSurfaces& surfaces, double tolerance);

/// The faces of a result that may be beyond the tolerance for whoever measures it again, as
/// rounding alone decides how they are cut into triangles (see `other_triangulations`), and those
/// beside them of which that is so. \pre `check_tolerance` finds nothing \return ascending
std::vector<Index> cells_in_doubt(const ComparedSurfaces& surfaces, double tolerance);

}  // namespace strake
