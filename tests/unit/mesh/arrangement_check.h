#pragma once

#include <string>

#include "common/core/line_set.h"
#include "common/core/tri_mesh.h"
#include "stages/mesh/overlay.h"

namespace strake {

/// What is wrong with the overlay of a mesh and lines that visit each face at most once; "" if
/// nothing: it is an embedding whose cells are disks, and those chords cross whose ends alternate
/// on the outline of their face.
/// \pre the mesh is a connected disk or sphere
std::string arrangement_fault(const TriMesh& mesh, const LineSet& lines, const Overlay& overlay);

}  // namespace strake
