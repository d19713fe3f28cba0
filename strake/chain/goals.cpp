#include "strake/chain/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/core/error.h"
#include "strake/chain/count_search.h"
#include "strake/chain/density_match.h"

namespace strake {
namespace {

/// Error of a wanted count above which the user is told.
constexpr double kCountTolerance = 0.05;
/// Share of a wanted count that may be missing; more is made up for by dividing cells, which costs
/// quads.
constexpr double kMissing = 0.02;
constexpr std::int64_t kFeedbackRounds = 1;
/// Share of the way to a density that is enough, and rounds that may be spent on it.
constexpr double kDensityReached = 0.9;
constexpr int kMostDensityRounds = 5;
/// Times that cells are divided and vertices fitted again on the way to a tolerance. Fitting makes
/// many cells good enough that would be divided without.
constexpr int kFittedRefinements = 2;
/// Times that lines are traced again, closer, where dividing cells does not reach a tolerance; and
/// at which share of their distances.
constexpr int kCloserLines = 2;
constexpr double kCloser = 0.6;
/// Rounds of fitting before errors are fed back: enough to see where they will stay.
constexpr int kFeedbackFitRounds = 3;

std::int64_t count_of(const Session& session, const char* port, Counted counted) {
  const PolyMesh& mesh = session.get<QuadMesh>(port).mesh;
  return counted == Counted::vertices ? mesh.vertex_count() : mesh.face_count();
}

const char* name_of(Counted counted) { return counted == Counted::vertices ? "vertices" : "faces"; }

void trace_and_mesh(Session& session, const GoalStages& stages) {
  session.run(stages.trace);
  session.run(stages.mesh);
}

/// Wants other distances between lines where the present result is too far from the surface, and
/// corrects the scale of all of them by the count.
void feed_back(Session& session, const GoalStages& stages, Counted counted, std::int64_t aim) {
  const Option& rounds = stages.fit.option("fit-rounds");
  const std::string all_rounds = rounds.value();
  rounds.parse_into(std::to_string(std::min(kFeedbackFitRounds, std::stoi(all_rounds))));
  session.run(stages.fit);
  rounds.parse_into(all_rounds);
  session.run(stages.size);
  const Option& scale = stages.trace.option("spacing-scale");
  const double excess =
      static_cast<double>(count_of(session, "quads", counted)) / static_cast<double>(aim);
  const double corrected = std::stod(scale.value()) * std::sqrt(excess);
  scale.parse_into(fmt::format("{}", std::clamp(corrected, scale.min, scale.max)));
}

/// Feeds errors back until the vertices are as the density wants them, as nearly as they get. Lines
/// go on where their neighbours are nearer than wanted, so its distances alone do little.
void follow_density(Session& session, const GoalStages& stages, Counted counted, std::int64_t aim) {
  Session plain = session;
  plain.withdraw("density");
  trace_and_mesh(plain, stages);
  const DensityMatch match(session.get<TriMesh>("mesh"), session.get<DensityField>("density"),
                           plain.get<QuadMesh>("quads"));
  const Option& scale = stages.trace.option("spacing-scale");
  Session best = session;
  std::string best_scale;
  double least_miss = std::numeric_limits<double>::infinity();
  for (int round = 0;; ++round) {
    trace_and_mesh(session, stages);
    const double reached = match.reached(session.get<QuadMesh>("quads"));
    if (std::abs(reached - 1) < least_miss) {
      least_miss = std::abs(reached - 1);
      best = session;
      best_scale = scale.value();
    }
    if (reached >= kDensityReached || round == kMostDensityRounds) break;
    feed_back(session, stages, counted, aim);
  }
  session = best;
  scale.parse_into(best_scale);
}

/// Looks for the scale of distances that gives the count. \pre traced and meshed at the present one
void search_scale(Session& session, const GoalStages& stages, Counted counted, std::int64_t aim) {
  const Option& option = stages.trace.option("spacing-scale");
  CountSearch search(aim, std::stod(option.value()), option.min, option.max);
  Session best = session;
  while (const std::optional<double> scale = search.next()) {
    option.parse_into(fmt::format("{}", *scale));
    try {
      trace_and_mesh(session, stages);
    } catch (const AlgorithmError& error) {
      if (search.trial_count() == 0) throw;
      session.say(std::string("warning: gave up correcting the count: ") + error.what());
      break;
    }
    const std::int64_t count = count_of(session, "quads", counted);
    session.say(fmt::format("{} {}, {} wanted", count, name_of(counted), aim));
    search.record(*scale, count);
    if (search.best().scale == *scale) best = session;
  }
  session = best;
  option.parse_into(fmt::format("{}", search.best().scale));
}

/// Whether every face must stay a quad, so that cells cannot be divided one by one.
bool only_quads(const GoalStages& stages) {
  return stages.mesh.option("pure-quads").value() == "true";
}

/// Fits the refined result once more.
void fit_refined(Session& session, const GoalStages& stages) {
  session.provide_as("quads", session.get<QuadMesh>("refined"), "refined");
  session.run(stages.fit);
}

/// Divides cells and fits vertices in turn, and divides once more.
/// \return the port of the result \throw ToleranceError where the tolerance is not reached
std::string refine_in_turn(Session& session, const GoalStages& stages) {
  const Option& rounds = stages.refine.option("refine-rounds");
  const Option& partly = stages.refine.option("refine-partly");
  const std::string all_rounds = rounds.value();
  const std::string may_miss = partly.value();
  partly.parse_into("true");
  for (int i = 0; i < std::min(kFittedRefinements, std::stoi(all_rounds)); ++i) {
    rounds.parse_into("1");
    session.run(stages.refine);
    fit_refined(session, stages);
  }
  rounds.parse_into(all_rounds);
  partly.parse_into(may_miss);
  session.run(stages.refine);
  session.keep(stages.refine);
  return "refined";
}

}  // namespace

std::string meet_count(Session& session, const GoalStages& stages, Counted counted,
                       std::int64_t wanted, std::optional<std::int64_t> feedback_rounds) {
  if (session.has("density") && !feedback_rounds) {
    follow_density(session, stages, counted, wanted);
  } else {
    for (std::int64_t round = 0; round < feedback_rounds.value_or(kFeedbackRounds); ++round) {
      trace_and_mesh(session, stages);
      feed_back(session, stages, counted, wanted);
    }
  }
  search_scale(session, stages, counted, wanted);
  session.keep(stages.trace);
  session.keep(stages.mesh);
  session.run(stages.fit);
  const std::int64_t missing = wanted - count_of(session, "fitted", counted);
  if (static_cast<double>(missing) > kMissing * static_cast<double>(wanted) &&
      !only_quads(stages)) {
    const std::int64_t vertices = count_of(session, "fitted", Counted::vertices) + missing;
    stages.refine.option("refine-vertices").parse_into(std::to_string(vertices));
    session.run(stages.refine);
    session.keep(stages.refine);
    fit_refined(session, stages);
  }
  session.keep(stages.fit);
  const std::int64_t reached = count_of(session, "fitted", counted);
  const double off = std::abs(static_cast<double>(reached - wanted)) / static_cast<double>(wanted);
  if (off > kCountTolerance) {
    session.say(fmt::format(
        "warning: {} {} were wanted, but the nearest result has {}: the shape, --max-spacing or "
        "the mesh's own resolution do not allow it",
        wanted, name_of(counted), reached));
  }
  return "fitted";
}

std::string follow_spacing(Session& session, const GoalStages& stages) {
  for (const Stage* stage : {&stages.trace, &stages.mesh, &stages.fit}) {
    session.run(*stage);
    session.keep(*stage);
  }
  return "fitted";
}

std::string meet_tolerance(Session& session, const GoalStages& stages,
                           const std::string& tolerance) {
  stages.refine.option("refine-tolerance").parse_into(tolerance);
  const Option& scale = stages.trace.option("spacing-scale");
  for (int closer = 0;; ++closer) {
    const std::string fitted = follow_spacing(session, stages);
    if (only_quads(stages)) {
      session.say(
          "warning: with --pure-quads cells are not divided: the tolerance steers the spacing of "
          "lines, and may be exceeded");
      return fitted;
    }
    try {
      return refine_in_turn(session, stages);
    } catch (const ToleranceError&) {
      if (closer == kCloserLines) throw;
    }
    session.say("dividing cells does not reach the tolerance; tracing closer lines");
    const double closer_scale = kCloser * std::stod(scale.value());
    scale.parse_into(fmt::format("{}", std::clamp(closer_scale, scale.min, scale.max)));
  }
}

}  // namespace strake
