#pragma once

#include <cstdint>

#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake::evaluation {

/// Faces of a mesh that pass through each other.
struct OwnCrossings {
  std::int64_t pairs = 0;
  Vec3 place = Vec3::Zero();  ///< where the deepest pair is, relative to the mesh's origin
};

/// Finds them. Faces that only touch, as sheets do along an edge that they had in common and
/// sides of solids against each other, are none, nor is what is less than 1e-6 of the diagonal
/// deep.
/// Cost O(F log F), parallel: a few per cent of a run that made a result.
OwnCrossings find_own_crossings(const TriMesh& mesh);

/// Where faces of the candidate cross, tells whether those of the reference do, too: reports
/// "shape.reference_crossing_pairs", and warns where there are any. Where none of the candidate's
/// cross the reference is not looked at.
/// \param pairs  faces of the candidate that meet in more than they share
void report_own_crossings(const TriMesh& reference, std::int64_t pairs, Report& report);

}  // namespace strake::evaluation
