#pragma once

#include "common/core/guides.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Lays guide lines onto a mesh, by nearest points.
///
/// Lines are halved until the nearest points of a piece's begin, middle and end lie in one face, or
/// in neighbours with the piece short against them. Left out are pieces between sheets that do not
/// meet, and what lies beside an open boundary.
/// \throw InputError naming file and guide where a place is farther than 2 % of the diagonal from
///        the surface, or no line is left
LaidGuides lay_guides(const TriMesh& mesh, const GuideLines& guides);

}  // namespace strake
