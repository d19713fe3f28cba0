#pragma once

#include <functional>
#include <set>
#include <span>
#include <vector>

#include "common/core/poly_mesh.h"

namespace strake {

/// Neighbouring faces, and quads with the same vertices that may be there instead.
struct Redivision {
  std::vector<Index> removed;             ///< two odd faces, and up to three quads between them
  std::vector<std::vector<Index>> added;  ///< quads
  std::vector<Index> outline;             ///< vertices around all of them, beginning with the least
  double price = 0;                       ///< the less, the better the quads
};

/// Finds odd faces that become quads by other edges between the vertices that are there: two faces
/// of three or five corners beside each other, or with up to three quads between them.
///
/// The quads are convex, have angles of 12 to 168 degrees and turn along their diagonals by less
/// than 60; no vertex inside is left with two edges, and no two vertices have two edges.
/// \param may_remove  whether the edge between two vertices may go
/// \param refused     outlines that are to stay as they are
/// \return no two of them with a vertex in common, the best first.
/// \pre an oriented 2-manifold
std::vector<Redivision> find_redivisions(const PolyMesh& mesh,
                                         const std::function<bool(Index, Index)>& may_remove,
                                         const std::set<std::vector<Index>>& refused);

/// Makes these changes.
/// \param change_of_face  [F of the result] number of the change that a face is of; kNone: none
PolyMesh redivide_faces(const PolyMesh& mesh, std::span<const Redivision> changes,
                        std::vector<Index>& change_of_face);

}  // namespace strake
