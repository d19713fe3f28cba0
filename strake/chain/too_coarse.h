#pragma once

#include <cstdint>

#include "common/geometry/face_crossings/crossing_places.h"
#include "strake/chain/counted.h"
#include "strake/chain/goal_stages.h"
#include "strake/chain/line_aim.h"
#include "strake/chain/session.h"

namespace strake {

/// Where lines are too coarse for the surface, looks whether decimation does much better.
///
/// They are where faces cross that do not in the surface, where the distance to it is what one sees
/// beside the size of a cell, or where the count is missed. Much better is a result that crosses
/// less, is at less than half of the distance (a quarter where that is below 6 % of a cell) or has
/// the count, and is in none of these worse; it
/// takes the place of "quads" and "fitted" then, "uncrossed" goes, and the user is told. Such a
/// result is quad-dominant by area, and follows edges of the surface rather than lines.
/// \pre what `result_port` names was made from lines for that count
/// \param crossing  of "mesh", like that of the others
/// \return whether it was decimated
bool decimate_if_too_coarse(Session& session, const GoalStages& stages, Counted counted,
                            std::int64_t wanted, CrossingPlaces& crossing);

/// Takes the input's own faces where those of a decimated result cross, and where that is not
/// enough decimates to counts nearby, whose collapses take other ways; the result with the fewest
/// stays.
/// \pre `decimate_if_too_coarse` decimated it to that count
/// \param crossing  of "mesh"
void part_decimated(Session& session, const GoalStages& stages, const LineAim& aim,
                    CrossingPlaces& crossing);

/// Where a tolerance is below the noise of a surface, so that many faces of the result cross that
/// do not in the surface, looks whether the surface decimated to no more vertices, all its own if
/// need be, is within it with far fewer of them.
///
/// That is "refined" then, and the user is told.
/// \pre "refined" is within the tolerance that refining has
/// \param crossing        of "mesh"
/// \param crossing_faces  of "refined", those of "mesh" not counted
/// \return whether it was decimated
bool decimate_if_tangled(Session& session, const GoalStages& stages, CrossingPlaces& crossing,
                         std::size_t crossing_faces);

/// Whether it would be decimated as it is: faces cross or it is farther off, and decimation is much
/// better.
bool decimation_is_better(const Session& session, const GoalStages& stages, Counted counted,
                          std::int64_t wanted, CrossingPlaces& crossing);

/// Whether a result made from lines misses the shape by so much, with cells of which one sees that,
/// that closer lines in places are in vain: decimation to the same count is at less than a quarter
/// of the distance.
bool lines_miss_shape(const Session& session, const GoalStages& stages, Counted counted,
                      std::int64_t wanted, CrossingPlaces& crossing);

}  // namespace strake
