#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/types.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {

/// Whether two triangles meet anywhere but in the corners and edges they share. Corners at the same
/// place are shared; triangles folded flat onto each other over a shared edge, and those at the
/// same three places, meet. What has no area meets nothing. Exact, see exact_predicates.h.
bool triangles_cross(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Finds the pairs of faces whose triangles cross. Triangles without area are left out.
/// \param positions  finite where used, any length unit
/// \return pairs of faces, the smaller first, ascending; the same for any number of threads
/// Cost O(T log T) for T triangles, as long as few of their boxes touch.
std::vector<std::array<Index, 2>> find_crossing_faces(const std::vector<Vec3>& positions,
                                                      const FaceTriangles& triangles);

/// The same for the pairs of which at least one face is wanted, and that are not known to cross.
/// \param wanted  [F] 0 or 1
/// \param known  pairs of faces, the smaller first, ascending; what is tested exactly takes its
/// time
std::vector<std::array<Index, 2>> find_crossing_faces(
    const std::vector<Vec3>& positions, const FaceTriangles& triangles,
    const std::vector<std::uint8_t>& wanted, const std::vector<std::array<Index, 2>>& known);

}  // namespace strake
