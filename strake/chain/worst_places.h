#pragma once

#include <cstdint>
#include <optional>

#include "strake/chain/goal_stages.h"
#include "strake/chain/line_aim.h"
#include "strake/chain/session.h"

namespace strake {

/// Brings the worst places of a result nearer to the surface (stages/refine/worst.h) where errors
/// say where vertices go, and it is not so large that its worst places are small. "improved" is the
/// result then, and kept.
/// \param aim  a count that stays nearly met; nothing: any may be
void improve_worst_places(Session& session, const GoalStages& stages,
                          const std::optional<LineAim>& aim);

}  // namespace strake
