#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

/// Edges that are bent less than creases, and are features where they stand alone.
namespace strake::import {

/// Whether an edge that is bent by `bend` stands alone, as those of a chamfer or of a roof do:
/// across it the surface goes on without another bend of that kind. On a coarsely meshed round each
/// edge has such neighbours.
///
/// Straight ways across both faces, at right angles to the middle of the edge and up to the next
/// barrier, tell. The edge does not stand alone where the surface turns about it by more than half
/// of `bend` again within 5 % of the diagonal on one side, or where on either side, at any
/// distance, one edge does.
///
/// \param normals  [F] unit
/// \param h        an inner half-edge
/// \param bend     radians
bool stands_alone(const TriMesh& mesh, const std::vector<Vec3>& normals, Index h, double bend);

/// Whether straight ways across both faces of an inner half-edge, from its middle, go on for its
/// length before they come to the next barrier: so it is where an edge lies across a strip between
/// creases, as the toe of a rib does, and not where it closes a bend of a crease.
bool lies_across(const TriMesh& mesh, const std::vector<Vec3>& normals, Index h);

}  // namespace strake::import
