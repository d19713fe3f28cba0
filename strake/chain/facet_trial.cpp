#include "strake/chain/facet_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "common/core/error.h"
#include "strake/chain/result_faults.h"

namespace strake {
namespace {

/// Largest distance, in mean cells, and share of odd faces from which on a result is poor.
constexpr double kFar = 0.05;
constexpr double kManyOdd = 0.08;
/// Share of the distance of the other result that is clearly nearer.
constexpr double kNearer = 0.5;
/// Share of all faces that may be odd besides, in a result that is nearer, or that are clearly
/// fewer.
constexpr double kMoreOdd = 0.05;
constexpr double kFewerOdd = 0.03;
/// Share of a count that may be missed.
constexpr double kMissed = 0.05;

bool is_poor(const ResultFaults& faults) {
  return faults.largest > kFar || faults.odd > kManyOdd || faults.crossing > 0 ||
         faults.missing > kMissed;
}

bool is_better(const ResultFaults& other, const ResultFaults& faults) {
  if (other.crossing > faults.crossing || other.missing > std::max(faults.missing, kMissed)) {
    return false;
  }
  const bool is_nearer =
      other.largest < kNearer * faults.largest && other.odd <= faults.odd + kMoreOdd;
  const bool has_fewer_odd = other.odd < faults.odd - kFewerOdd && other.largest <= faults.largest;
  return is_nearer || has_fewer_odd;
}

/// Holds warnings of what may not be the result back.
class HeldWarnings : public StageObserver {
 public:
  explicit HeldWarnings(StageObserver& user) : user_(user) {}
  void begin(const std::string& stage) override { user_.begin(stage); }
  void report(std::string_view phase, double fraction) override { user_.report(phase, fraction); }
  void say(const std::string& line) override {
    if (line.starts_with("warning: ")) {
      held_.push_back(line);
    } else {
      user_.say(line);
    }
  }
  void release() const {
    for (const std::string& line : held_) user_.say(line);
  }

 private:
  StageObserver& user_;
  std::vector<std::string> held_;
};

/// The values of all options of stages, to return to.
class OptionValues {
 public:
  explicit OptionValues(const std::vector<const Stage*>& stages) {
    for (const Stage* stage : stages) {
      for (const Option& option : stage->options) values_.emplace_back(&option, option.value());
    }
  }
  void restore() const {
    for (const auto& [option, value] : values_) option->parse_into(value);
  }

 private:
  std::vector<std::pair<const Option*, std::string>> values_;
};

bool has_facets(const Session& session) {
  for (const StageRecord& record : session.records()) {
    for (const auto& [name, value] : record.report.entries()) {
      if (name == "features.facet_edges") return std::get<std::int64_t>(value) > 0;
    }
  }
  return false;
}

}  // namespace

std::string make_with_facets_if_better(Session& session, const WayToResult& way,
                                       const Option& facet_height, const Length& height,
                                       Counted counted, std::int64_t wanted) {
  StageObserver& user = session.observer();
  const Session read = session;
  const OptionValues at_first(way.stages);
  HeldWarnings of_plain(user);
  session.report_to(of_plain);
  way.import_mesh(session);
  std::string port = way.reach_goal(session);
  session.report_to(user);
  const ResultFaults plain = faults_of(session, counted, wanted);
  const auto keep_plain = [&] {
    of_plain.release();
    return port;
  };
  if (!is_poor(plain)) return keep_plain();

  const OptionValues of_result(way.stages);
  const auto begin_with_facets = [&](Session& again) {
    at_first.restore();
    facet_height.parse_into(height.to_string());
    way.import_mesh(again);
  };
  HeldWarnings of_faceted(user);
  Session other = read;
  other.keep_with({}, {});
  other.report_to(of_faceted);
  std::string other_port;
  bool is_taken = false;
  begin_with_facets(other);
  if (has_facets(other)) {
    user.say("the mesh is coarse for this count; keeping edges between its facets to compare");
    try {
      other_port = way.reach_goal(other);
      is_taken = is_better(faults_of(other, counted, wanted), plain);
    } catch (const AlgorithmError& error) {
      user.say(std::string("warning: left edges between facets out: ") + error.what());
    }
  }
  if (!is_taken) {
    of_result.restore();
    return keep_plain();
  }
  user.say("kept edges between facets");
  of_faceted.release();
  if (!session.keeps()) {
    session = std::move(other);
    session.report_to(user);
    return other_port;
  }
  HeldWarnings said_before(user);
  session = read;
  session.report_to(said_before);
  begin_with_facets(session);
  port = way.reach_goal(session);
  session.report_to(user);
  return port;
}

}  // namespace strake
