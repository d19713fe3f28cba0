#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/geometry/face_crossings/crossing_places.h"
#include "strake/chain/counted.h"
#include "strake/chain/goal_stages.h"
#include "strake/chain/line_aim.h"
#include "strake/chain/result_faults.h"
#include "strake/chain/session.h"

namespace strake {

/// Whether decimation may not take the place of lines: it knows nothing of what a user says of
/// directions and of lines.
/// \param lines_only  the option of the chain
bool needs_lines(const Session& session, const GoalStages& stages, bool lines_only);

/// The surface decimated to a wanted count, to compare with what lines give. It is made when first
/// asked for, and once.
class DecimatedRival {
 public:
  /// \param stages  kept by reference
  DecimatedRival(const GoalStages& stages, Counted counted, std::int64_t wanted)
      : stages_(stages), counted_(counted), wanted_(wanted) {}

  // Of what `result_port` of a session names, made from lines for that count; the session's mesh is
  // the same each time, and `crossing` is of it.

  /// Whether decimation is much better: it crosses less, is at less than half of the distance (a
  /// quarter where that is below 6 % of a cell) or has the count, and is in none of these worse.
  bool is_better(const Session& session, CrossingPlaces& crossing);

  /// Whether lines miss the shape by so much, with cells of which one sees that, that closer ones
  /// in places are in vain: decimation is at less than a quarter of the distance.
  bool shows_what_lines_miss(const Session& session, CrossingPlaces& crossing);

  /// Where lines are too coarse for the surface, looks whether decimation is much better.
  ///
  /// They are where faces cross that do not in the surface, where the distance to it is what one
  /// sees beside the size of a cell, or where the count is missed. A better result takes the place
  /// of "quads" and "fitted", "uncrossed" goes, and the user is told. It is quad-dominant by area,
  /// and follows edges of the surface rather than lines.
  /// \return whether it was decimated
  bool replace_if_too_coarse(Session& session, CrossingPlaces& crossing);

 private:
  /// What it takes to make it a session's result.
  struct Made {
    Session session;
    ResultFaults faults;
  };

  /// \return nullptr where it cannot be made
  const Made* made(const Session& session, CrossingPlaces& crossing);

  const GoalStages& stages_;
  Counted counted_;
  std::int64_t wanted_;
  std::optional<Made> made_;
  std::string why_not_;  ///< empty: it can be made, as far as is known
};

/// Takes the input's own faces where those of a decimated result cross, and where that is not
/// enough decimates to counts nearby, whose collapses take other ways; the result with the fewest
/// stays.
/// \pre a `DecimatedRival` of that count has taken its place
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

}  // namespace strake
