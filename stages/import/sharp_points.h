#pragma once

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Flags the tips of cones in `is_corner`: inner vertices off feature lines whose angles miss 20
/// degrees or more of a full turn, while all vertices around miss less than half of that together.
///
/// Those of a round tip, of noise and of coarse round surfaces miss about as much as each other.
/// \pre topology, features and other corners are known
/// \return number of tips
Index find_sharp_points(TriMesh& mesh);

}  // namespace strake::import
