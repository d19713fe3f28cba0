#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "strake/chain/counted.h"
#include "strake/chain/goal_stages.h"
#include "strake/chain/session.h"

namespace strake {

/// Traces until the result has about the wanted count, with the errors of its cells made even.
///
/// In the first `feedback_rounds` rounds lines are traced again at distances that follow from the
/// errors measured (by default one, with a density as many as it takes to follow it, up to five);
/// then only the scale of all distances changes. Lines leave a hundredth of the count to the cells
/// that are farthest off, which are divided; with a density cells are only where more than 5 % of
/// the count would be missing. Where faces of the result cross, the input's own take their place
/// (uncross.h), and where some still do lines are traced closer there and the count is looked for
/// again. Where lines are too coarse for the surface decimation may take their place
/// (too_coarse.h). Where the input is much finer than the result all but the last rounds of fitting
/// happens on a coarser mesh (working_mesh.h).
/// \param wanted         vertices or faces, as `counted` says; positive
/// \param lines_only     never decimate
/// \param working_ratio  vertices of the coarser mesh for each that is wanted; 0: never
/// \return the port of the result
/// \throw AlgorithmError where a stage has no sound result
std::string meet_count(Session& session, const GoalStages& stages, Counted counted,
                       std::int64_t wanted, std::optional<std::int64_t> feedback_rounds,
                       bool lines_only, double working_ratio);

/// Traces at the distances that the options of tracing ask for, closer where many faces cross, and
/// by default once more at such that make errors even with about as many lines. Divides the worst
/// cells then, and takes the input's own faces where single faces of the result cross.
/// \return the port of the result
std::string follow_spacing(Session& session, const GoalStages& stages,
                           std::optional<std::int64_t> feedback_rounds);

/// Traces, by default once more with closer lines where errors are too large, and divides cells
/// until the result is within a tolerance of the surface, both ways; where that is not reached, or
/// faces of the result cross, again with closer lines. Where many still do decimation may take the
/// place of lines (too_coarse.h), but not with `lines_only`.
/// \param tolerance  as `Length::to_string` gives it
/// \return the port of the result
/// \throw ToleranceError naming places where that is not reached
std::string meet_tolerance(Session& session, const GoalStages& stages, const std::string& tolerance,
                           std::optional<std::int64_t> feedback_rounds, bool lines_only);

}  // namespace strake
