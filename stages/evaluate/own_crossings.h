#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/report.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake::evaluation {

/// Faces of a mesh that pass through each other.
struct OwnCrossings {
  std::int64_t pairs = 0;
  std::int64_t touching = 0;        ///< pairs that meet and do not pass through each other
  bool between_parts = false;       ///< whether any pair is of two components
  bool between_open_parts = false;  ///< likewise, both with a boundary
  Vec3 place = Vec3::Zero();        ///< where the deepest pair is, relative to the mesh's origin
};

/// Finds them. Faces that only touch, as sheets do along an edge that they had in common and
/// sides of solids against each other, are none, nor is what is less than 1e-6 of the diagonal
/// deep.
/// Cost O(F log F), parallel: a few per cent of a run that made a result.
OwnCrossings find_own_crossings(const TriMesh& mesh);

/// Tells how many of the pairs of faces of the candidate only touch: "shape.touching_pairs". Where
/// others cross, tells whether faces of the reference do, too: reports
/// "shape.reference_crossing_pairs", and warns where there are any, or where some touch. Where none
/// of the candidate's cross the reference is not looked at.
/// \param positions, triangles  of the candidate, relative to the reference's origin
/// \param pairs  faces of the candidate that meet in more than they share
void report_own_crossings(const TriMesh& reference, const std::vector<Vec3>& positions,
                          const FaceTriangles& triangles,
                          const std::vector<std::array<Index, 2>>& pairs, Report& report);

}  // namespace strake::evaluation
