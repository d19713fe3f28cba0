#pragma once

#include <cstdint>
#include <optional>

#include "strake/chain/goal_stages.h"
#include "strake/chain/line_aim.h"
#include "strake/chain/session.h"

namespace strake {

/// Rounds in which errors are fed back where nobody says how many.
inline constexpr std::int64_t kFeedbackRounds = 1;

/// Whether cells may be divided where errors are largest: a density says where vertices go, not the
/// errors.
bool goes_by_errors(const Session& session, const GoalStages& stages);

/// Looks for the scale of distances that gives the count, from the present one on; what is missing
/// or too much in the end strips of quads make up for. Where all are too far above or below it, as
/// on coarse meshes, takes what is not too far below where cells can be divided.
/// \param with_strips  false: only where nothing else comes near the count
/// \return whether they do
bool search_scale(Session& session, const GoalStages& stages, const LineAim& aim,
                  bool with_strips = true);

/// Feeds errors back, with a density until vertices are as it wants them, and looks for the count.
/// \return as `search_scale`
bool find_lines(Session& session, const GoalStages& stages, const LineAim& aim,
                std::optional<std::int64_t> feedback_rounds);

}  // namespace strake
