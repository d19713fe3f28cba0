#pragma once

#include <cstdint>
#include <vector>

#include "common/core/tri_mesh.h"
#include "stages/trace/spacing.h"

namespace strake {

/// [F] 1: of a component that is nowhere as large as the distances wanted on it: its bounding box
/// has a diagonal of at most the smallest of them.
///
/// A line there would wind around its component many times within one step.
std::vector<std::uint8_t> faces_of_specks(const TriMesh& mesh, const Spacing& spacing);

}  // namespace strake
