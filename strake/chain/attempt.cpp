#include "strake/chain/attempt.h"

#include <fmt/format.h>

#include <utility>

#include "common/core/error.h"
#include "stages/size/closer_near.h"

namespace strake {
namespace {

/// Factor on the distances of lines around faces that cross.
constexpr double kCloser = 0.7;
constexpr int kMostAttempts = 5;
/// Where more faces cross the shape is finer than its lines all over.
constexpr std::size_t kMostPlaces = 1000;

}  // namespace

void want_closer(Session& session, const GoalStages& stages, const std::vector<Vec3>& places,
                 double factor) {
  session.provide(
      "size",
      closer_near(session.get<TriMesh>("mesh"), session.get<LineSet>("lines"), places, factor),
      "closer lines", "");
  stages.trace.option("spacing-scale").parse_into("1");  // the distances have it in them
}

Attempt part_faces(const Attempt& first, const GoalStages& stages, int patience,
                   const std::function<Attempt(Session)>& again,
                   const std::function<void(Attempt&)>& keep) {
  Attempt best = first;
  Attempt last = first;
  bool is_last_best = true;
  const auto is_worth_it = [&] {
    return patience > 0 && !best.places.empty() && best.places.size() <= kMostPlaces;
  };
  for (int i = 0; i < kMostAttempts && is_worth_it(); ++i) {
    Session session = last.done;
    session.say(fmt::format("{} faces cross; tracing closer lines around {} places",
                            best.places.size(), last.places.size()));
    want_closer(session, stages, last.places, kCloser);
    try {
      last = again(std::move(session));
    } catch (const AlgorithmError&) {
      is_last_best = false;
      break;
    }
    if (last.misses_goal || 2 * last.places.size() > best.places.size()) --patience;
    is_last_best = !last.misses_goal && last.places.size() < best.places.size();
    if (is_last_best) best = last;
  }
  if (!is_last_best) keep(best);
  return best;
}

}  // namespace strake
