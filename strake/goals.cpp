#include "strake/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/core/error.h"
#include "strake/count_search.h"

namespace strake {
namespace {

/// Error of a wanted count above which the user is told.
constexpr double kCountTolerance = 0.05;
/// Share of a wanted count that may be missing; more is made up for by dividing cells, which costs
/// quads.
constexpr double kMissing = 0.02;
/// Times that cells are divided and vertices fitted again on the way to a tolerance. Fitting makes
/// many cells good enough that would be divided without.
constexpr int kFittedRefinements = 2;

std::int64_t count_of(const Pipeline& pipeline, const char* port, Counted counted) {
  const PolyMesh& mesh = pipeline.get<QuadMesh>(port).mesh;
  return counted == Counted::vertices ? mesh.vertex_count() : mesh.face_count();
}

const char* name_of(Counted counted) { return counted == Counted::vertices ? "vertices" : "faces"; }

void trace_and_mesh(Pipeline& pipeline, const GoalStages& stages) {
  pipeline.run(stages.trace);
  pipeline.run(stages.mesh);
}

/// Wants other distances between lines where the present result is too far from the surface, and
/// corrects the scale of all of them by the count.
void feed_back(Pipeline& pipeline, const GoalStages& stages, Counted counted, std::int64_t aim) {
  pipeline.run(stages.fit);
  pipeline.run(stages.size);
  const Option& scale = stages.trace.option("spacing-scale");
  const double excess =
      static_cast<double>(count_of(pipeline, "quads", counted)) / static_cast<double>(aim);
  const double corrected = std::stod(scale.value()) * std::sqrt(excess);
  scale.parse_into(fmt::format("{}", std::clamp(corrected, scale.min, scale.max)));
}

/// Looks for the scale of distances that gives the count. \pre traced and meshed at the present one
void search_scale(Pipeline& pipeline, const GoalStages& stages, Counted counted, std::int64_t aim,
                  ConsoleObserver& console) {
  const Option& option = stages.trace.option("spacing-scale");
  CountSearch search(aim, std::stod(option.value()), option.min, option.max);
  Pipeline best = pipeline;
  while (const std::optional<double> scale = search.next()) {
    option.parse_into(fmt::format("{}", *scale));
    try {
      trace_and_mesh(pipeline, stages);
    } catch (const AlgorithmError& error) {
      if (search.trial_count() == 0) throw;
      console.say(std::string("warning: gave up correcting the count: ") + error.what());
      break;
    }
    const std::int64_t count = count_of(pipeline, "quads", counted);
    console.say(fmt::format("{} {}, {} wanted", count, name_of(counted), aim));
    search.record(*scale, count);
    if (search.best().scale == *scale) best = pipeline;
  }
  pipeline = best;
  option.parse_into(fmt::format("{}", search.best().scale));
}

/// Whether every face must stay a quad, so that cells cannot be divided one by one.
bool only_quads(const GoalStages& stages) {
  return stages.mesh.option("pure-quads").value() == "true";
}

/// Fits the refined result once more.
void fit_refined(Pipeline& pipeline, const GoalStages& stages) {
  pipeline.provide_as("quads", pipeline.get<QuadMesh>("refined"), "refined");
  pipeline.run(stages.fit);
}

}  // namespace

std::string meet_count(Pipeline& pipeline, const GoalStages& stages, Counted counted,
                       std::int64_t wanted, std::int64_t feedback_rounds,
                       ConsoleObserver& console) {
  for (std::int64_t round = 0; round < feedback_rounds; ++round) {
    trace_and_mesh(pipeline, stages);
    feed_back(pipeline, stages, counted, wanted);
  }
  search_scale(pipeline, stages, counted, wanted, console);
  pipeline.keep(stages.trace);
  pipeline.keep(stages.mesh);
  pipeline.run(stages.fit);
  const std::int64_t missing = wanted - count_of(pipeline, "fitted", counted);
  if (static_cast<double>(missing) > kMissing * static_cast<double>(wanted) &&
      !only_quads(stages)) {
    const std::int64_t vertices = count_of(pipeline, "fitted", Counted::vertices) + missing;
    stages.refine.option("refine-vertices").parse_into(std::to_string(vertices));
    pipeline.run(stages.refine);
    pipeline.keep(stages.refine);
    fit_refined(pipeline, stages);
  }
  pipeline.keep(stages.fit);
  const std::int64_t reached = count_of(pipeline, "fitted", counted);
  const double off = std::abs(static_cast<double>(reached - wanted)) / static_cast<double>(wanted);
  if (off > kCountTolerance) {
    console.say(fmt::format(
        "warning: {} {} were wanted, but the nearest result has {}: the shape, --max-spacing or "
        "the mesh's own resolution do not allow it",
        wanted, name_of(counted), reached));
  }
  return "fitted";
}

std::string follow_spacing(Pipeline& pipeline, const GoalStages& stages) {
  for (const Stage* stage : {&stages.trace, &stages.mesh, &stages.fit}) {
    pipeline.run(*stage);
    pipeline.keep(*stage);
  }
  return "fitted";
}

std::string meet_tolerance(Pipeline& pipeline, const GoalStages& stages,
                           const std::string& tolerance, ConsoleObserver& console) {
  const std::string fitted = follow_spacing(pipeline, stages);
  stages.refine.option("refine-tolerance").parse_into(tolerance);
  if (only_quads(stages)) {
    console.say(
        "warning: with --pure-quads cells are not divided: the tolerance steers the spacing of "
        "lines, and may be exceeded");
    return fitted;
  }
  const Option& rounds = stages.refine.option("refine-rounds");
  const Option& partly = stages.refine.option("refine-partly");
  const std::string all_rounds = rounds.value();
  const std::string may_miss = partly.value();
  partly.parse_into("true");
  for (int i = 0; i < std::min(kFittedRefinements, std::stoi(all_rounds)); ++i) {
    rounds.parse_into("1");
    pipeline.run(stages.refine);
    fit_refined(pipeline, stages);
  }
  rounds.parse_into(all_rounds);
  partly.parse_into(may_miss);
  pipeline.run(stages.refine);
  pipeline.keep(stages.refine);
  return "refined";
}

}  // namespace strake
