#pragma once

#include <functional>

#include "strake/chain/attempt.h"

namespace strake {

/// Where lines are farther apart than a detail is wide, a bore or the tip of an ear, cells pass it
/// by. Makes the result again with closer lines at places that are far off the surface compared to
/// the size of cells, as long as that brings them nearer. Leaves large results as they are: each
/// attempt takes as long as the first one.
/// \param first  for a count
/// \param again  as of `part_faces`
/// \param keep   keeps one again
/// \return the attempt whose farthest place is nearest, and otherwise no worse; it is the one kept
Attempt regain_details(const Attempt& first, const Again& again,
                       const std::function<void(Attempt&)>& keep);

}  // namespace strake
