#include "stages/trace/grading.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

#include "stages/trace/spacing.h"

namespace strake {
namespace {

/// Aspect ratio that grading may give to cells where curvature asks for none.
constexpr double kGradedAspect = 2;
/// Values that are passed on by one thread at a time.
constexpr std::size_t kKeysAtOnce = 512;

/// Keys that wait for their turn, by intervals of their values from the least on. None may be added
/// below the interval whose turn it is.
class WaitingKeys {
 public:
  /// \param width  of the intervals; they are wider where there would be too many
  WaitingKeys(double least, double largest, double width)
      : least_(least),
        per_width_(1 / std::max({width, (largest - least) / kMostIntervals,
                                 std::numeric_limits<double>::min()})),
        waiting_(interval_of(largest) + 1) {}

  void push(double value, Index key) { waiting_[interval_of(value)].push_back(key); }

  /// Takes out the keys of the first interval that has any.
  /// \param value  [keys] the present ones; keys that are in an earlier interval now are left out
  std::vector<Index> pop(const std::vector<double>& value) {
    for (; turn_ < waiting_.size(); ++turn_) {
      std::vector<Index> keys;
      keys.swap(waiting_[turn_]);
      std::erase_if(keys, [&](Index key) { return interval_of(value[key]) != turn_; });
      if (!keys.empty()) return keys;
    }
    return {};
  }

 private:
  static constexpr double kMostIntervals = 1 << 16;

  [[nodiscard]] std::size_t interval_of(double value) const {
    return static_cast<std::size_t>((value - least_) * per_width_);
  }

  double least_;
  double per_width_;
  std::vector<std::vector<Index>> waiting_;
  std::size_t turn_ = 0;
};

/// Lowers a value that others may lower at the same time. \return whether it was above `reach`
bool lower_to(double& value, double reach) {
  const std::atomic_ref shared(value);
  double present = shared.load(std::memory_order_relaxed);
  while (reach < present) {
    if (shared.compare_exchange_weak(present, reach, std::memory_order_relaxed)) return true;
  }
  return false;
}

class Grading {
 public:
  Grading(const ArmBonds& bonds, double gradation, const Spacing& spacing)
      : bonds_(bonds),
        gradation_(gradation),
        value_(2 * spacing.along.size()),
        aspect_(spacing.along.size()) {
    for (std::size_t w = 0; w < aspect_.size(); ++w) {
      value_[2 * w] = spacing.along[w];
      value_[2 * w + 1] = spacing.across[w];
      // Where the surface itself is not anisotropic, neither should grading make the cells so.
      const auto [small, large] = std::minmax(spacing.along[w], spacing.across[w]);
      aspect_[w] = std::max(kGradedAspect, large / small);
    }
  }

  /// By waves from the least values outwards.
  void run() {
    const auto [least, largest] = std::ranges::minmax(value_);
    WaitingKeys waiting(least, largest, gradation_ * bonds_.mean_length());
    // Those that bound another now; the rest follows.
    std::vector<std::uint8_t> is_bound(value_.size());
    tbb::parallel_for(std::size_t{0}, value_.size(), [&](std::size_t at) {
      const auto key = static_cast<Index>(at);
      for_bounds(key, value_[key], [&](Index other, double bound) {
        if (bound < value_[other]) is_bound[key] = 1;
      });
    });
    for (std::size_t key = 0; key < value_.size(); ++key) {
      if (is_bound[key] != 0) waiting.push(value_[key], static_cast<Index>(key));
    }
    // Rounding keeps the order of numbers, so the largest values within all bounds come out
    // whatever the order in which an interval is worked off.
    tbb::enumerable_thread_specific<std::vector<Index>> lowered;
    for (std::vector<Index> now = waiting.pop(value_); !now.empty(); now = waiting.pop(value_)) {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, now.size(), kKeysAtOnce),
                        [&](const tbb::blocked_range<std::size_t>& some) {
                          std::vector<Index>& mine = lowered.local();
                          for (std::size_t i = some.begin(); i < some.end(); ++i) {
                            pass_on(now[i], mine);
                          }
                        });
      for (std::vector<Index>& keys : lowered) {
        for (const Index key : keys) waiting.push(value_[key], key);
        keys.clear();
      }
    }
  }

  void store(Spacing& spacing) const {
    for (std::size_t w = 0; w < aspect_.size(); ++w) {
      spacing.along[w] = value_[2 * w];
      spacing.across[w] = value_[2 * w + 1];
    }
  }

 private:
  /// Calls use(other key, bound) for all values that the one of a key bounds.
  template <class Use>
  void for_bounds(Index key, double value, const Use& use) const {
    use(key ^ 1, aspect_[key / 2] * value);
    for (Index at = bonds_.first(key / 2); at < bonds_.first(key / 2 + 1); ++at) {
      use(bonds_.bonded(at, key), value + gradation_ * bonds_.length(at, key / 2));
    }
    bonds_.for_each_tied(key, [&](Index other) { use(other, value); });
  }

  void pass_on(Index key, std::vector<Index>& lowered) {
    const double value = std::atomic_ref(value_[key]).load(std::memory_order_relaxed);
    for_bounds(key, value, [&](Index other, double bound) {
      if (lower_to(value_[other], bound)) lowered.push_back(other);
    });
  }

  const ArmBonds& bonds_;
  double gradation_;
  std::vector<double> value_;   ///< [keys]
  std::vector<double> aspect_;  ///< [W] largest ratio
};

}  // namespace

void grade_spacing(const ArmBonds& bonds, double gradation, Spacing& spacing) {
  Grading grading(bonds, gradation, spacing);
  grading.run();
  grading.store(spacing);
}

}  // namespace strake
