#include "strake/chain/count_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strake {

CountSearch::CountSearch(std::int64_t target, double first_scale, double min_scale,
                         double max_scale)
    : target_(static_cast<double>(target)),
      first_scale_(first_scale),
      min_scale_(min_scale),
      max_scale_(max_scale) {}

double CountSearch::error(std::int64_t count) const {
  return std::abs(static_cast<double>(count) - target_) / target_;
}

bool CountSearch::is_good_enough(std::int64_t count) const {
  return error(count) <= (static_cast<double>(count) < target_ ? kMostMissing : kMostExcess);
}

double CountSearch::excess(std::int64_t count) const {
  return std::log(std::max<double>(static_cast<double>(count), 1) / target_);
}

void CountSearch::record(double scale, std::int64_t count) { trials_.push_back({scale, count}); }

const CountSearch::Trial& CountSearch::best() const {
  return *std::min_element(trials_.begin(), trials_.end(), [&](const Trial& a, const Trial& b) {
    return std::abs(excess(a)) < std::abs(excess(b));
  });
}

std::optional<std::pair<CountSearch::Trial, CountSearch::Trial>> CountSearch::nearest_bracket()
    const {
  std::vector<Trial> by_scale = trials_;
  std::ranges::sort(by_scale, {}, &Trial::scale);
  std::optional<std::pair<Trial, Trial>> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < by_scale.size(); ++i) {
    const Trial& many = by_scale[i - 1];
    const Trial& few = by_scale[i];
    const double errors = excess(many) - excess(few);
    if (!(excess(many) > 0) || excess(few) > 0 || !(errors < least)) continue;
    least = errors;
    nearest = {many, few};
  }
  return nearest;
}

double CountSearch::guess() const {
  if (const auto bracket = nearest_bracket()) {
    const auto& [many, few] = *bracket;
    const double low = std::log(many.scale);
    const double high = std::log(few.scale);
    // Away from the ends, so that a crooked curve cannot hold the search at one of them.
    const double share = std::clamp(excess(many) / (excess(many) - excess(few)), 0.1, 0.9);
    return std::exp(low + share * (high - low));
  }
  const Trial& near = best();
  double slope = -2;
  for (const Trial& other : trials_) {
    if (other.scale == near.scale) continue;
    const double measured =
        (excess(near) - excess(other)) / (std::log(near.scale) - std::log(other.scale));
    slope = std::clamp(measured, -4.0, -0.5);
  }
  constexpr double kLongestStep = 1.5;
  const double step = std::clamp(-excess(near) / slope, -kLongestStep, kLongestStep);
  return near.scale * std::exp(step);
}

std::optional<double> CountSearch::next() const {
  if (trials_.empty()) return first_scale_;
  if (trials_.size() >= kMaxTrials || is_good_enough(best().count)) return std::nullopt;
  const double scale = std::clamp(guess(), min_scale_, max_scale_);
  for (const Trial& trial : trials_) {
    if (std::abs(std::log(trial.scale / scale)) < 1e-6) return std::nullopt;
  }
  return scale;
}

}  // namespace strake
