#include "strake/chain/facet_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "common/core/error.h"
#include "common/core/wanted_count.h"
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
/// Share of all faces that may be thin besides: between edges of facets there is little room.
constexpr double kMoreThin = 0.03;

bool is_poor(const ResultFaults& faults) {
  return faults.largest > kFar || faults.odd > kManyOdd || faults.crossing > 0 ||
         faults.missing > kCountTolerance;
}

bool is_better(const ResultFaults& other, const ResultFaults& faults) {
  if (other.crossing > faults.crossing ||
      other.missing > std::max(faults.missing, kCountTolerance) ||
      other.thin > faults.thin + kMoreThin) {
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
    if (line.starts_with("warning: ") || line.find(": warning: ") != std::string::npos) {
      lines_.push_back(line);
    } else {
      user_.say(line);
    }
  }
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  StageObserver& user_;
  std::vector<std::string> lines_;
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
    if (record.report.number("features.facet_edges").value_or(0) > 0) return true;
  }
  return false;
}

/// A result of which nothing is kept.
struct Trial {
  Session session;
  std::string port;
  std::vector<std::string> warnings;
  ResultFaults faults;
};

}  // namespace

std::string make_with_facets_if_better(Session& session, const WayToResult& way,
                                       const Option& facet_height, const Length& height,
                                       Counted counted, std::int64_t wanted) {
  StageObserver& user = session.observer();
  const OptionValues at_first(way.stages);
  const auto import_into = [&](Session& to, bool with_facets) {
    at_first.restore();
    if (with_facets) facet_height.parse_into(height.to_string());
    way.import_mesh(to);
  };
  const auto try_out = [&](bool with_facets) -> std::optional<Trial> {
    HeldWarnings held(user);
    Session tried = session;
    tried.keep_with({}, {});
    tried.report_to(held);
    import_into(tried, with_facets);
    if (with_facets && !has_facets(tried)) return std::nullopt;
    if (with_facets) user.say("the mesh is coarse for this count; trying with edges of its facets");
    const std::string port = way.reach_goal(tried);
    tried.report_to(user);
    CrossingPlaces crossing(tried.get<TriMesh>("mesh"));
    return Trial{tried, port, held.lines(), faults_of(tried, counted, wanted, crossing)};
  };

  Trial taken = *try_out(false);
  const OptionValues of_plain(way.stages);
  bool with_facets = false;
  if (is_poor(taken.faults)) {
    try {
      std::optional<Trial> other = try_out(true);
      with_facets = other && is_better(other->faults, taken.faults);
      if (with_facets) taken = *std::move(other);
    } catch (const AlgorithmError& error) {
      user.say(std::string("warning: left edges of facets out: ") + error.what());
    }
  }
  if (with_facets) user.say("kept edges of facets");
  for (const std::string& line : taken.warnings) user.say(line);
  if (!session.keeps()) {
    if (!with_facets) of_plain.restore();
    session = std::move(taken.session);
    return taken.port;
  }
  // Once more: what is kept is to be of nothing else.
  HeldWarnings said_before(user);
  session.report_to(said_before);
  std::string port;
  try {
    import_into(session, with_facets);
    port = way.reach_goal(session);
  } catch (...) {
    session.report_to(user);
    throw;
  }
  session.report_to(user);
  return port;
}

}  // namespace strake
