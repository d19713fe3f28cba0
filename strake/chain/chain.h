#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/options.h"
#include "common/core/wanted_count.h"
#include "common/stage/stage.h"
#include "strake/chain/goal_stages.h"
#include "strake/chain/session.h"

namespace strake {

/// The standard chain from a mesh as read to a measured result. Copies share option values.
struct Chain : GoalStages {
  Chain();

  Stage import;
  Stage evaluate;

  std::optional<std::int64_t> feedback_rounds;  ///< as the goals take them
  bool lines_only = false;                      ///< likewise
  double working_ratio = 10;                    ///< likewise
  /// The options of the chain as a whole, which point into this object.
  OptionList declare() { return declare(feedback_rounds, lines_only, working_ratio); }
  static OptionList declare(std::optional<std::int64_t>& feedback_rounds, bool& lines_only,
                            double& working_ratio);

  /// All stages, in the order of their first run.
  [[nodiscard]] std::vector<const Stage*> stages() const;
  /// \throw UsageError where more than one goal is given, or an option of a stage that follows from
  /// the goal
  void check_goals() const;
  /// Runs all stages but the last that the goal takes, as often as it takes them. Changes option
  /// values on the way.
  /// \pre the session was provided with "input" and what else is known
  /// \return the port of the result
  std::string run(Session& session) const;
  /// Runs the last one, on the result.
  /// \return its report
  /// \throw AlgorithmError where it finds the goal's tolerance exceeded, which `run` has proven
  const Report& measure(Session& session, const std::string& port) const;

 private:
  /// Within a tolerance, sets the height of ridges where nothing was said of it.
  void keep_ridges() const;
  /// Height above which edges between facets may be features; nothing where the goal is no count
  /// with room for them, or the user says what features are.
  /// \param diagonal  of the input, model units
  [[nodiscard]] std::optional<Length> height_of_facets(const Session& session,
                                                       double diagonal) const;
  struct WantedCount {
    Counted counted;
    std::int64_t count;
  };
  [[nodiscard]] std::optional<WantedCount> wanted_count() const;
  /// Makes a result for a count, with edges between facets as features or without.
  /// \param height  of these
  std::string run_with_facets(Session& session, const Length& height) const;
  void import_mesh(Session& session) const;
  std::string reach_goal(Session& session) const;
};

}  // namespace strake
