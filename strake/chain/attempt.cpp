#include "strake/chain/attempt.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "common/core/error.h"
#include "common/core/tolerance_error.h"

namespace strake {
namespace {

constexpr Index kMostAttempts = 8;
/// Faces of all attempts together; one is made of any number.
constexpr Index kMostFaces = 200000;
/// Where more faces cross, or a larger share of all, the shape is finer than its lines all over.
constexpr std::size_t kMostPlaces = 1000;
constexpr double kMostShare = 0.3;
/// Share of faces that cross from which on attempts are given up after the first ones in vain.
constexpr double kLargeShare = 0.05;
constexpr int kShortPatience = 2;
/// Attempts in a row that may leave no fewer faces that cross than the best one before.
constexpr int kMostWithoutGain = 2;
/// Attempts that leave more than half of the faces that cross, after which giving up is considered.
constexpr int kSlowOnes = 2;

/// One more attempt; nothing where it comes to no result, or to none within a tolerance.
std::optional<Attempt> attempt_again(const Again& again, Session session,
                                     const std::vector<Vec3>& places) {
  try {
    return again(std::move(session), places);
  } catch (const AlgorithmError&) {
    return std::nullopt;
  } catch (const ToleranceError&) {
    return std::nullopt;
  }
}

}  // namespace

Attempt part_faces(const Attempt& first, Index faces, int patience, const Again& again,
                   const GiveUp& give_up, const std::function<void(Attempt&)>& keep) {
  Attempt best = first;
  Attempt last = first;
  bool is_last_best = true;
  const auto most =
      std::min(kMostPlaces, static_cast<std::size_t>(kMostShare * static_cast<double>(faces)));
  const double share = static_cast<double>(first.places.size()) / faces;
  if (share > kLargeShare) patience = std::min(patience, kShortPatience);
  int without_gain = 0;
  int slow = 0;
  const auto is_worth_it = [&] {
    return patience > 0 && without_gain < kMostWithoutGain && !best.places.empty() &&
           best.places.size() <= most;
  };
  const Index attempts =
      std::clamp<Index>(kMostFaces / std::max<Index>(faces, 1), 1, kMostAttempts);
  for (Index i = 0; i < attempts && is_worth_it(); ++i) {
    Session session = last.done;
    const std::vector<Vec3> before = last.places;
    session.say(fmt::format("{} faces cross; tracing closer lines around {} places",
                            best.places.size(), last.places.size()));
    std::optional<Attempt> next = attempt_again(again, std::move(session), before);
    if (!next) {
      is_last_best = false;
      break;
    }
    last = *std::move(next);
    const bool is_slow = last.misses_goal || 2 * last.places.size() > best.places.size();
    if (is_slow) --patience;
    is_last_best = !last.misses_goal && last.places.size() < best.places.size();
    without_gain = is_last_best ? 0 : without_gain + 1;
    if (is_last_best) best = last;
    if (last.places == before) break;  // lines are as close as they may be: all would be the same
    if (is_slow && ++slow == kSlowOnes && is_worth_it() && give_up(best)) break;
  }
  if (!is_last_best) keep(best);
  return best;
}

}  // namespace strake
