#include "strake/chain/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/border_course.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "stages/mesh/mesh.h"
#include "strake/chain/attempt.h"
#include "strake/chain/closer_lines.h"
#include "strake/chain/goal_warnings.h"
#include "strake/chain/line_aim.h"
#include "strake/chain/line_search.h"
#include "strake/chain/line_steps.h"
#include "strake/chain/lost_details.h"
#include "strake/chain/replace_crossing.h"
#include "strake/chain/too_coarse.h"
#include "strake/chain/working_mesh.h"
#include "strake/chain/worst_places.h"

namespace strake {
namespace {

/// Share of a wanted count that lines leave for dividing the cells that are worst. Half of it
/// already takes a twelfth off the errors, and an eighth off the largest.
constexpr double kLeftForWorst = 0.01;
/// Share that dividing may add to what lines give, as each vertex costs a quad and makes others
/// irregular; more only where the count would be missed otherwise.
constexpr double kMostDivided = 0.01;
/// Times that cells are divided and vertices fitted again on the way to a tolerance. Fitting makes
/// many cells good enough that would be divided without.
constexpr int kFittedRefinements = 2;
/// Times that lines are traced closer around the places where dividing cells does not reach a
/// tolerance, and at which share of their distances.
constexpr int kCloserPlaces = 8;
constexpr double kCloserThere = 0.5;
/// Times that all lines are, where that is not enough.
constexpr int kCloserLines = 2;
/// Share of the faces that cross from which on, within a tolerance, lines are traced closer before
/// cells are divided, and share of the result from which on it is made anew.
constexpr double kTangled = 0.5;
constexpr double kTangledResult = 0.1;
/// Times that lines are traced closer where nobody wants a count and faces cross after all that is
/// done about single ones.
constexpr int kMostTimesCloserAtLast = 1;
/// Attempts in vain to part faces that cross; within a tolerance the input's own faces have been
/// tried for them before.
constexpr int kPatience = 5;
constexpr int kPatienceWithinTolerance = 2;
/// Vertices, over those of the first result, that are looked for where nobody wants a count and
/// lines are traced closer in places.
constexpr double kRoomToMend = 1.05;
/// Share of the distances of lines around faces that cross.
constexpr double kCloserWhereCrossing = 0.7;
/// Share of the distances around details that lines miss.
constexpr double kCloserAtDetails = 0.5;
/// Corners of features for each vertex or face wanted, from which on they may be too many, and how
/// far they may come to lie off features then.
constexpr double kManyCorners = 0.25;
/// Share of a wanted count by which lines miss it, from which on decimation to theirs is tried,
/// too.
constexpr double kFarFromCount = 0.25;
constexpr const char* kAnyDistance = "1";

/// Divides cells and fits vertices in turn, and divides once more.
/// \return what the result misses; nothing where "refined" is within the tolerance
std::optional<ToleranceError> refine_in_turn(Session& session, const GoalStages& stages) {
  const Option& rounds = stages.refine.option("refine-rounds");
  const double most = std::min<double>(kFittedRefinements, *rounds.number());
  for (int i = 0; i < most; ++i) {
    const OtherValue once(rounds, "1");
    const OtherValue may_miss(stages.refine.option("refine-partly"), "true");
    session.run(stages.refine);
    fit_refined(session, stages);
  }
  std::optional<ToleranceError> miss;
  try {
    session.run(stages.refine);
  } catch (const ToleranceError& error) {
    miss = error;
  }
  if (!miss) session.keep(stages.refine);
  return miss;
}

/// Traces at the distances that the options ask for, and closer where dividing cells does not reach
/// the tolerance: around the places that are left, and everywhere where that is not enough. Once
/// more where it is reached by faces that cross all over.
/// \param times_everywhere  at most
/// \return what is within it
/// \throw ToleranceError where nothing helps
Attempt trace_within(Session& session, const GoalStages& stages, CrossingPlaces& crossing,
                     int times_everywhere) {
  std::optional<Attempt> tangled;
  for (int trial = 0;; ++trial) {
    trace_apart(session, stages, crossing, tangled ? kMended : kTangled);
    const Session meshed = session;
    const std::optional<ToleranceError> miss = refine_in_turn(session, stages);
    if (!miss) {
      Attempt found = {meshed, session, crossing.of(session.get<QuadMesh>("refined").mesh)};
      if (tangled && tangled->places.size() <= found.places.size()) break;
      const double share = crossing_share(session, "refined", found.places);
      if (tangled || share <= kTangledResult || !may_be_too_coarse(session, "refined")) {
        return found;
      }
      tangled = std::move(found);
      scale_lines(stages, kCloser * line_scale(stages));
      continue;
    }
    const bool is_once = stages.refine.option("refine-rounds").value() == "0";
    if (is_once || trial == kCloserPlaces + times_everywhere) {
      if (tangled) break;
      throw *miss;
    }
    if (trial < kCloserPlaces) {
      session.say(
          fmt::format("tracing closer lines around {} places that dividing cells does not bring "
                      "within the tolerance",
                      miss->places().size()));
      want_closer_only_there(session, stages, miss->places(), kCloserThere);
    } else {
      session.say("dividing cells does not reach the tolerance; tracing closer lines");
      scale_lines(stages, kCloser * line_scale(stages));
    }
  }
  // What was made anew is no better, or not within the tolerance.
  keep_fitted(tangled->meshed, stages);
  tangled->done.keep(stages.refine);
  return *tangled;
}

/// Vertices or faces that dividing cells is to add to those that lines give.
std::int64_t to_add(std::int64_t given, const LineAim& aim) {
  const auto have = static_cast<double>(given);
  const auto wanted = static_cast<double>(aim.wanted);
  const double nearly = (1 - 0.8 * kCountTolerance) * wanted;
  const double most = std::max((1 + kMostDivided) * have, nearly);
  return std::llround(std::max(std::min(wanted, most) - have, aim.left / 2 * wanted));
}

/// Divides the worst cells for what is missing of the count, fits vertices and parts faces that
/// cross.
/// \pre traced and meshed
Attempt fit_to_count(Session session, const GoalStages& stages, const LineAim& aim,
                     CrossingPlaces& crossing) {
  session.keep(stages.trace);
  session.keep(stages.mesh);
  const Session meshed = session;
  const std::int64_t given = count_of(session, "quads", aim.counted);
  const double missing = 1 - static_cast<double>(given) / static_cast<double>(aim.wanted);
  if (aim.left > 0 || (missing > kCountTolerance && !only_quads(stages))) {
    fit_before_dividing(session, stages);
    const std::int64_t vertices =
        count_of(session, "fitted", Counted::vertices) + to_add(given, aim);
    stages.refine.option("refine-vertices").parse_into(std::to_string(vertices));
    session.run(stages.refine);
    session.keep(stages.refine);
    fit_refined(session, stages);
  } else {
    session.run(stages.fit);
  }
  session.keep(stages.fit);
  std::vector<Vec3> places = replace_crossing(session, stages, aim, crossing);
  return {meshed, session, std::move(places)};
}

void keep_attempt(Attempt& attempt, const GoalStages& stages) {
  attempt.meshed.keep(stages.trace);
  attempt.meshed.keep(stages.mesh);
  if (attempt.done.has("refined")) attempt.done.keep(stages.refine);
  attempt.done.keep(stages.fit);
}

/// Share of the wanted count that the result of an attempt is off by.
double miss_of(const Attempt& attempt, const LineAim& aim) {
  return aim.miss(count_of(attempt.done, result_port(attempt.done), aim.counted));
}

/// Fits what gives a count. Where faces cross then, which strips hardly change, tries what lines
/// alone give; the first result stays where that comes to none, or misses the count.
Attempt fit_either(Session session, const GoalStages& stages, const LineAim& aim,
                   CrossingPlaces& crossing, bool has_strips) {
  Attempt first = fit_to_count(session, stages, aim, crossing);
  if (!has_strips || first.places.empty()) return first;
  session.say(fmt::format("{} faces cross; looking for other lines", first.places.size()));
  const Option& scale = stages.trace.option("spacing-scale");
  const std::string scale_before = scale.value();
  try {
    search_scale(session, stages, aim, false);
    Attempt other = fit_to_count(session, stages, aim, crossing);
    const bool is_met = miss_of(other, aim) <= std::max(miss_of(first, aim), kCountTolerance);
    if (is_met && other.places.size() < first.places.size()) return other;
  } catch (const AlgorithmError& error) {
    session.say(std::string("warning: kept the first lines: ") + error.what());
  }
  scale.parse_into(scale_before);
  keep_attempt(first, stages);
  return first;
}

LineAim aim_of(const Session& session, const GoalStages& stages, Counted counted,
               std::int64_t wanted) {
  const double left = goes_by_errors(session, stages) ? kLeftForWorst : 0;
  return {counted, std::llround((1 - left) * static_cast<double>(wanted)), wanted, left};
}

/// Whether lines give more than may be.
bool is_exceeded(const Session& session, const LineAim& aim) {
  const std::int64_t given = count_of(session, "quads", aim.counted);
  return given > aim.wanted && aim.miss(given) > kCountTolerance;
}

/// Wants lines closer around places. \param factor  on distances there, from 0 to 1
using WantCloser = std::function<void(Session&, const std::vector<Vec3>& places, double factor)>;

/// Parts faces that cross, and brings lost details back, by closer lines there; the count is looked
/// for again each time, from the scale on that `want_closer` leaves.
/// \param give_up  see `part_faces`
/// \return the best attempt, which is kept
Attempt mend_by_closer_lines(const Attempt& first, const GoalStages& stages, const LineAim& aim,
                             const WantCloser& want_closer, const GiveUp& give_up,
                             CrossingPlaces& crossing) {
  const double first_miss = miss_of(first, aim);
  const auto closer_by = [&](double factor, bool with_strips) {
    return [&, factor, with_strips](Session next, const std::vector<Vec3>& places) {
      want_closer(next, places, factor);
      search_scale(next, stages, aim, with_strips);
      Attempt attempt = fit_to_count(next, stages, aim, crossing);
      attempt.misses_goal = miss_of(attempt, aim) > std::max(first_miss, kCountTolerance);
      return attempt;
    };
  };
  const auto keep = [&](Attempt& attempt) { keep_attempt(attempt, stages); };
  bool is_given_up = false;
  const GiveUp asked = [&](const Attempt& best) { return is_given_up = give_up(best); };
  Attempt best = part_faces(first, first.done.get<QuadMesh>("fitted").mesh.face_count(), kPatience,
                            closer_by(kCloserWhereCrossing, false), asked, keep);
  // Where lines miss the count they have no room for details.
  if (first_miss > kCountTolerance || is_given_up) return best;
  return regain_details(best, closer_by(kCloserAtDetails, true), keep);
}

/// Traces, feeds errors back, looks for the count, fits, and traces closer where faces cross.
/// \param rival  where decimation may take their place: no lines are looked for where they are in
///               vain; nullptr: it may not
void trace_to_count(Session& session, const GoalStages& stages, const LineAim& aim,
                    std::optional<std::int64_t> feedback_rounds, DecimatedRival* rival) {
  bool has_strips = find_lines(session, stages, aim, feedback_rounds);
  // Corners of features stay where that is possible at this count.
  const Option& distance = stages.mesh.option("corner-distance");
  const bool is_users = distance.number() != MeshOptions{}.corner_distance;
  const bool are_many = corner_count(session) > kManyCorners * static_cast<double>(aim.wanted);
  std::optional<OtherValue> merging;
  if (!is_users && are_many && is_exceeded(session, aim)) {
    const Option& scale = stages.trace.option("spacing-scale");
    const std::string scale_before = scale.value();
    merging.emplace(distance, kAnyDistance);
    bool is_nearer = false;
    try {
      Session merged = session;
      const bool merged_has_strips = search_scale(merged, stages, aim);
      is_nearer = aim.ratio_miss(count_of(merged, "quads", aim.counted)) <
                  aim.ratio_miss(count_of(session, "quads", aim.counted));
      if (is_nearer) {
        session = std::move(merged);
        has_strips = merged_has_strips;
      }
    } catch (const AlgorithmError& error) {
      session.say(std::string("warning: kept all corners: ") + error.what());
    }
    if (!is_nearer) {
      merging.reset();
      scale.parse_into(scale_before);
    }
  }
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  const Attempt first = fit_either(session, stages, aim, crossing, has_strips);
  const bool is_in_vain = rival != nullptr && !first.places.empty() &&
                          rival->shows_what_lines_miss(first.done, crossing);
  const GiveUp for_decimation = [&](const Attempt& best) {
    return rival != nullptr && rival->is_better(best.done, crossing);
  };
  session = is_in_vain ? first.done
                       : mend_by_closer_lines(first, stages, aim, want_relatively_closer,
                                              for_decimation, crossing)
                             .done;
}

/// Fits what the present lines give, with some more vertices by dividing the worst cells, and again
/// with closer lines where a detail is lost and no faces cross.
/// \param left  share of these, as in LineAim
Attempt fit_freely(const Session& session, const GoalStages& stages, double left) {
  const std::int64_t count = count_of(session, "quads", Counted::vertices);
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  const Attempt first =
      fit_to_count(session, stages, {Counted::vertices, count, count, left}, crossing);
  const std::int64_t more = std::llround(kRoomToMend * static_cast<double>(count));
  const LineAim aim{Counted::vertices, more, more, left};
  const auto want_closer = [&](Session& next, const std::vector<Vec3>& places, double factor) {
    want_closer_for_as_many(next, stages, places, factor);
  };
  // On broken meshes faces cross whatever is tried.
  const bool is_sound = first.places.empty();
  return is_sound ? mend_by_closer_lines(first, stages, aim, want_closer, never_give_up, crossing)
                  : first;
}

/// Whether closer lines may keep faces of a result from crossing: not where the input's do.
bool may_be_parted(const Attempt& attempt) {
  if (attempt.places.empty() || !may_be_too_coarse(attempt.done, "quads")) return false;
  CrossingPlaces crossing(attempt.done.get<TriMesh>("mesh"));
  // Of the input it knows what is near the faces that it was asked for.
  crossing.of(attempt.done.get<QuadMesh>(result_port(attempt.done)).mesh);
  return !crossing.input_crosses();
}

}  // namespace

std::string meet_count(Session& session, const GoalStages& stages, Counted counted,
                       std::int64_t wanted, std::optional<std::int64_t> feedback_rounds,
                       bool lines_only, double working_ratio) {
  std::optional<Session> coarser = on_coarser_mesh(session, stages, wanted, working_ratio);
  if (!coarser) estimate_field(session, stages);
  const LineAim aim = aim_of(session, stages, counted, wanted);
  std::optional<DecimatedRival> rival;
  if (!needs_lines(session, stages, lines_only)) rival.emplace(stages, counted, wanted);
  trace_to_count(coarser ? *coarser : session, stages, aim, feedback_rounds,
                 rival && !coarser ? &*rival : nullptr);
  if (coarser) {
    if (coarser->has("uncrossed")) coarser->keep(stages.uncross);
    take_from_coarser_mesh(session, std::move(*coarser), stages);
  }
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  if (coarser) replace_crossing(session, stages, aim, crossing);
  const std::int64_t given = count_of(session, result_port(session), counted);
  if (rival && rival->replace_if_too_coarse(session, crossing)) {
    part_decimated(session, stages, aim, crossing);
  } else if (rival && aim.miss(given) > kFarFromCount) {
    // For so few the shape may not do at all, which it does for as many as lines take.
    DecimatedRival other(stages, counted, given);
    if (other.replace_if_too_coarse(session, crossing)) {
      part_decimated(session, stages, {counted, given, given, 0}, crossing);
    }
  }
  if (session.has("uncrossed")) session.keep(stages.uncross);
  improve_worst_places(session, stages, aim);
  warn_of_count(session, aim);
  return result_port(session);
}

std::string follow_spacing(Session& session, const GoalStages& stages,
                           std::optional<std::int64_t> feedback_rounds) {
  estimate_field(session, stages);
  // A density says where vertices go, not the errors.
  const std::int64_t rounds =
      feedback_rounds.value_or(session.has("density") ? 0 : kFeedbackRounds);
  double scale = 1;
  const auto attempt = [&] {
    Session traced = session;
    const FreeTrace trace = trace_freely(traced, stages, rounds);
    scale = trace.scale;
    const bool by_errors = trace.looked_at_errors && goes_by_errors(traced, stages);
    return fit_freely(traced, stages, by_errors ? kLeftForWorst : 0);
  };
  Attempt best = attempt();
  for (int i = 0; i < kMostTimesCloserAtLast && may_be_parted(best); ++i) {
    session.say(fmt::format("{} faces cross; tracing closer lines", best.places.size()));
    scale_lines(stages, kCloser * scale);
    try {
      Attempt other = attempt();
      if (other.places.size() < best.places.size()) {
        best = std::move(other);
        continue;
      }
    } catch (const AlgorithmError& error) {
      session.say(std::string("warning: kept the first lines: ") + error.what());
    }
    keep_attempt(best, stages);
  }
  session = best.done;
  if (session.has("uncrossed")) session.keep(stages.uncross);
  improve_worst_places(session, stages, std::nullopt);
  return result_port(session);
}

std::string meet_tolerance(Session& session, const GoalStages& stages, const std::string& tolerance,
                           std::optional<std::int64_t> feedback_rounds, bool lines_only) {
  stages.refine.option("refine-tolerance").parse_into(tolerance);
  if (const Option& border = stages.mesh.option("border-distance"); border.value().empty()) {
    Length most = Length::parse(tolerance);
    most.value *= kCourseOfTolerance;
    border.parse_into(most.to_string());
  }
  estimate_field(session, stages);
  for (std::int64_t i = 0; i < feedback_rounds.value_or(kFeedbackRounds); ++i) {
    shrink_to_tolerance(session, stages, tolerance);
  }
  if (only_quads(stages)) {
    session.say(
        "warning: with --pure-quads cells are not divided: the tolerance steers the spacing of "
        "lines, and may be exceeded");
    trace_and_mesh(session, stages);
    session = fit_freely(session, stages, 0).done;
    return result_port(session);
  }
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  const Attempt first = trace_within(session, stages, crossing, kCloserLines);
  const auto again = [&](Session next, const std::vector<Vec3>& places) {
    want_closer_only_there(next, stages, places, kCloserWhereCrossing);
    return trace_within(next, stages, crossing, 0);
  };
  const auto keep = [&](Attempt& attempt) {
    keep_fitted(attempt.meshed, stages);
    attempt.done.keep(stages.refine);
  };
  const Index faces = first.done.get<QuadMesh>("refined").mesh.face_count();
  const Attempt best =
      part_faces(first, faces, kPatienceWithinTolerance, again, never_give_up, keep);
  session = best.done;
  const bool may_be_decimated = !needs_lines(session, stages, lines_only);
  if (may_be_decimated && decimate_if_tangled(session, stages, crossing, best.places.size())) {
    return "refined";
  }
  warn_of_excess(session);
  return "refined";
}

}  // namespace strake
