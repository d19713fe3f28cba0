#pragma once

#include <cstdint>
#include <vector>

#include "common/core/types.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "strake/chain/goal_stages.h"
#include "strake/chain/session.h"

namespace strake {

/// Share of their distances at which all lines are traced closer.
inline constexpr double kCloser = 0.6;
/// Share of the faces that cross to which closer lines are to bring it within a tolerance.
inline constexpr double kMended = 0.3;

/// Whether there are fewer vertices than the input has, so that lines may be too coarse for it.
bool may_be_too_coarse(const Session& session, const char* port);

/// \param places  of the faces at a port that cross \return their share
double crossing_share(const Session& session, const char* port, const std::vector<Vec3>& places);

/// Traces, meshes and fits; where more faces cross than `most`, as lines are farther apart than the
/// shape is thick, at closer distances until so few do that they can be mended. Within a tolerance
/// larger than that nothing else tells that faces are inside out.
void trace_apart(Session& session, const GoalStages& stages, CrossingPlaces& crossing, double most);

/// How lines were traced without a goal.
struct FreeTrace {
  double scale = 1;  ///< of the distances that curvature gives, before errors were made even
  bool looked_at_errors = false;
};

/// Traces, and closer where so many faces cross, or they are so far off, that lines are too coarse
/// for the shape. Then makes errors even, unless that brings crossing faces back.
FreeTrace trace_freely(Session& session, const GoalStages& stages, std::int64_t feedback_rounds);

}  // namespace strake
