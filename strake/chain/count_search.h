#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace strake {

/// Finds the scale at which a count that falls with the scale is as wanted.
///
/// Regula falsi on log(count) over log(scale), from two neighbouring tries on either side of the
/// target; before there are two, counts are taken to fall with the square of the scale, as elements
/// of an area do. Deterministic: the same counts give the same scales.
class CountSearch {
 public:
  struct Trial {
    double scale = 1;
    std::int64_t count = 0;
  };

  static constexpr int kMaxTrials = 6;
  /// Relative errors at which the search ends. What is missing is made up for by dividing cells,
  /// which costs quads.
  static constexpr double kMostMissing = 0.02;
  static constexpr double kMostExcess = 0.03;

  /// \param target  wanted count, positive
  CountSearch(std::int64_t target, double first_scale, double min_scale, double max_scale);

  /// The scale to try next; nothing once the count is good enough or nothing is left to try.
  [[nodiscard]] std::optional<double> next() const;
  /// Tells what came of the scale that `next` gave.
  void record(double scale, std::int64_t count);

  /// The trial whose ratio to the target is nearest to one: half as many are as far off as twice as
  /// many.
  /// \pre one was recorded
  [[nodiscard]] const Trial& best() const;
  [[nodiscard]] std::size_t trial_count() const { return trials_.size(); }
  /// Relative distance of a count from the target.
  [[nodiscard]] double error(std::int64_t count) const;
  /// How far its ratio to the target is from one: half as many are as far off as twice as many.
  [[nodiscard]] double ratio_miss(std::int64_t count) const { return std::abs(excess(count)); }
  [[nodiscard]] bool is_good_enough(std::int64_t count) const;

 private:
  /// log(count / target): positive where there are too many.
  [[nodiscard]] double excess(std::int64_t count) const;
  [[nodiscard]] double excess(const Trial& trial) const { return excess(trial.count); }
  /// Two trials next to each other in scale, of which the first has too many and the second too
  /// few: the nearest ones, as counts can go up and down again.
  [[nodiscard]] std::optional<std::pair<Trial, Trial>> nearest_bracket() const;
  [[nodiscard]] double guess() const;

  double target_;
  double first_scale_;
  double min_scale_;
  double max_scale_;
  std::vector<Trial> trials_;
};

}  // namespace strake
