#include "strake/chain/line_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/error.h"
#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "strake/chain/count_search.h"
#include "strake/chain/density_match.h"
#include "strake/chain/line_steps.h"
#include "strake/chain/replace_crossing.h"

namespace strake {
namespace {

/// Share of a count that lines must give for cells to be divided until it is met: where it is less
/// the shape is not in the lines.
constexpr double kLeastToDivide = 0.5;
/// Share of the way to a density that is enough, and rounds that may be spent on it. Of the rounds
/// the nearest counts, before or beyond.
constexpr double kDensityReached = 1;
constexpr int kMostDensityRounds = 5;
/// Share of that way by which the result may miss it before the count is looked for once more, and
/// times it is.
constexpr double kDensityMissed = 0.1;
constexpr int kMostDensitySearches = 3;
/// Share of that way from which on nobody needs to be told.
constexpr double kDensityMet = 0.67;
/// Share of a count up to which strips of quads make up for what lines give too little or too much:
/// in the first trials, later, and where no scale of distances comes nearer. Lines at the right
/// distances are better where there are few of them, and they come at once; large results only wait
/// for them.
constexpr double kWithinFewStrips = 0.035;
constexpr std::size_t kTrialsOfLines = 2;
constexpr std::int64_t kManyWanted = 1000;
constexpr double kWithinStrips = 0.08;
constexpr double kWithinStripsAtLast = 0.5;

/// Nodes that lines may have, and times the count, beyond which nobody needs cells to see that
/// there are too many of them: on needles and spikes thousands come at once.
constexpr std::int64_t kManyNodes = 20000;
constexpr std::int64_t kFarTooMany = 10;
/// Likewise the chords of one family in one face, where these are more than the count.
constexpr std::int64_t kManyChords = 2000;
/// Times that lines which are far too many are traced at larger distances before there are cells.
constexpr int kMostThinnings = 4;

/// Of lines that are far too many for the count, the vertices to take them for; otherwise nothing.
std::optional<std::int64_t> far_too_many(const Session& session, const LineAim& aim) {
  const LineLoad load = load_of(session.get<TriMesh>("mesh"), session.get<LineSet>("lines"));
  if (load.nodes <= std::max(kManyNodes, kFarTooMany * aim.count) &&
      load.fullest_face <= std::max(kManyChords, aim.count)) {
    return std::nullopt;
  }
  return std::max(load.nodes, load.fullest_face);
}

/// Traces and makes cells anew, at larger distances where lines are far too many: expected vertices
/// say nothing on spikes, around which each line goes on and on.
void trace_and_mesh_for(Session& session, const GoalStages& stages, const LineAim& aim) {
  trace_anew(session, stages);
  for (int round = 0; round < kMostThinnings; ++round) {
    const std::optional<std::int64_t> vertices = far_too_many(session, aim);
    if (!vertices) break;
    const double excess = static_cast<double>(*vertices) / static_cast<double>(aim.count);
    scale_lines(stages, line_scale(stages) * std::sqrt(excess));
    trace_anew(session, stages);
  }
  session.run(stages.mesh);
}

DensityMatch match_density(const Session& session, const GoalStages& stages) {
  Session plain = session;
  plain.withdraw("density");
  trace_and_mesh(plain, stages);
  return {session.get<TriMesh>("mesh"), session.get<DensityField>("density"),
          plain.get<QuadMesh>("quads")};
}

/// The session, with the scale of its lines, that follows a density best so far.
class BestMatch {
 public:
  /// \param scale  of the stage trace
  BestMatch(const DensityMatch& match, const Option& scale) : match_(match), scale_(scale) {}

  /// \return what the session reaches
  double offer(const Session& session) {
    const double reached = match_.reached(session.get<QuadMesh>("quads"));
    if (!best_ || std::abs(reached - 1) < least_miss_) {
      least_miss_ = std::abs(reached - 1);
      best_ = session;
      best_scale_ = scale_.value();
    }
    return reached;
  }
  /// \pre one was offered
  void take(Session& session) const {
    session = *best_;
    scale_.parse_into(best_scale_);
  }

 private:
  const DensityMatch& match_;
  const Option& scale_;
  std::optional<Session> best_;
  std::string best_scale_;
  double least_miss_ = 0;
};

/// Feeds errors back until the vertices are as the density wants them, as nearly as they get. Lines
/// go on where their neighbours are nearer than wanted, so its distances alone do little.
void follow_density(Session& session, const GoalStages& stages, const DensityMatch& match,
                    const LineAim& aim) {
  BestMatch best(match, stages.trace.option("spacing-scale"));
  for (int round = 0;; ++round) {
    trace_and_mesh(session, stages);
    if (best.offer(session) >= kDensityReached || round == kMostDensityRounds) break;
    feed_back(session, stages, aim);
  }
  best.take(session);
}

/// Looks for the count, and feeds errors back again where the lines found follow the density less.
void search_with_density(Session& session, const GoalStages& stages, const DensityMatch& match,
                         const LineAim& aim) {
  BestMatch best(match, stages.trace.option("spacing-scale"));
  for (int search = 0; search < kMostDensitySearches; ++search) {
    if (search > 0) feed_back(session, stages, aim);
    search_scale(session, stages, aim);
    if (std::abs(best.offer(session) - 1) <= kDensityMissed) break;
  }
  best.take(session);
}

void warn_of_density(Session& session, const DensityMatch& match) {
  const double reached = match.reached(session.get<QuadMesh>("quads"));
  if (reached >= kDensityMet) return;
  session.say(fmt::format(
      "warning: the density is followed for {:.0f} % of the way only: cells cannot differ as much "
      "as it does from place to place, or are no smaller than the vertices wanted allow; let it "
      "change over a longer way, or ask for more vertices",
      100 * std::max(0.0, reached)));
}

}  // namespace

bool goes_by_errors(const Session& session, const GoalStages& stages) {
  return !only_quads(stages) && !session.has("density");
}

bool search_scale(Session& session, const GoalStages& stages, const LineAim& aim,
                  bool with_strips) {
  const Option& option = stages.trace.option("spacing-scale");
  CountSearch search(aim.count, line_scale(stages), option.min, option.max);
  struct Found {
    Session session;
    double scale;
    std::int64_t count;
    bool has_strips;
  };
  std::optional<Found> best;
  std::optional<Found> below;
  const auto use_strips = [&] {
    try {
      mesh_with_strips(session, stages, aim);
    } catch (const AlgorithmError& error) {
      session.say(std::string("warning: left strips of quads as they were: ") + error.what());
    }
    const std::int64_t count = count_of(session, "quads", aim.counted);
    session.say(
        fmt::format("{} {} with strips of quads split or taken out", count, name_of(aim.counted)));
    return count;
  };
  while (const std::optional<double> scale = search.next()) {
    option.parse_into(fmt::format("{}", *scale));
    try {
      trace_anew(session, stages);
      if (const std::optional<std::int64_t> vertices = far_too_many(session, aim)) {
        search.record(*scale, *vertices);
        continue;
      }
      session.run(stages.mesh);
    } catch (const AlgorithmError& error) {
      if (!best) throw;
      session.say(std::string("warning: gave up correcting the count: ") + error.what());
      break;
    }
    std::int64_t count = count_of(session, "quads", aim.counted);
    session.say(fmt::format("{} {} so far, {} wanted", count, name_of(aim.counted), aim.wanted));
    search.record(*scale, count);
    const bool are_enough = search.trial_count() > kTrialsOfLines || aim.wanted >= kManyWanted;
    const double within = are_enough ? kWithinStrips : kWithinFewStrips;
    const bool has_strips =
        with_strips && !search.is_good_enough(count) && search.error(count) <= within;
    if (has_strips) count = use_strips();
    if (!best || search.ratio_miss(count) < search.ratio_miss(best->count)) {
      best = {session, *scale, count, has_strips};
    }
    if (search.is_good_enough(count)) break;
    const bool can_be_divided =
        count <= aim.count &&
        static_cast<double>(count) >= kLeastToDivide * static_cast<double>(aim.count);
    if (can_be_divided && (!below || count > below->count))
      below = {session, *scale, count, has_strips};
  }
  if (!best) {  // all are far too many, so it cannot be helped
    session.run(stages.mesh);
    best = {session, line_scale(stages), count_of(session, "quads", aim.counted), false};
  }
  const bool is_missed = search.error(best->count) > kCountTolerance;
  const Found& chosen = is_missed && below && goes_by_errors(session, stages) ? *below : *best;
  session = chosen.session;
  option.parse_into(fmt::format("{}", chosen.scale));
  if (!is_missed || search.error(chosen.count) > kWithinStripsAtLast) return chosen.has_strips;
  use_strips();
  return true;
}

bool find_lines(Session& session, const GoalStages& stages, const LineAim& aim,
                std::optional<std::int64_t> feedback_rounds) {
  if (session.has("density") && !feedback_rounds) {
    const DensityMatch match = match_density(session, stages);
    follow_density(session, stages, match, aim);
    search_with_density(session, stages, match, aim);
    warn_of_density(session, match);
    return false;
  }
  for (std::int64_t round = 0; round < feedback_rounds.value_or(kFeedbackRounds); ++round) {
    trace_and_mesh_for(session, stages, aim);
    feed_back(session, stages, aim);
  }
  return search_scale(session, stages, aim);
}

}  // namespace strake
