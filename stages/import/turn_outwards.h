#pragma once

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Turns closed components that are inside out over, with what lies inside of them.
/// \param mesh  its topology is built anew
/// \pre build_topology has run; no features and no wedges yet
/// \return how many components were turned
/// Cost as that of `judge_closed_components`.
Index turn_outwards(TriMesh& mesh);

}  // namespace strake::import
