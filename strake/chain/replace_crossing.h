#pragma once

#include <vector>

#include "common/core/types.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "strake/chain/goal_stages.h"
#include "strake/chain/line_aim.h"
#include "strake/chain/session.h"

namespace strake {

/// Whether every face must stay a quad, so that cells cannot be changed one by one.
bool only_quads(const GoalStages& stages);

/// Takes the input's own faces where faces cross, or few of them touch, as long as the count allows
/// it.
/// \return places where faces still cross
/// \pre fitted
std::vector<Vec3> replace_crossing(Session& session, const GoalStages& stages, const LineAim& aim,
                                   CrossingPlaces& crossing);

}  // namespace strake
