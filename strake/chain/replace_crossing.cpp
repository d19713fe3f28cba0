#include "strake/chain/replace_crossing.h"

#include <algorithm>
#include <string>

#include "common/core/error.h"

namespace strake {
namespace {

/// Faces that cross, up to which the input's own are tried in their place for a count.
constexpr std::size_t kMostReplaced = 1000;

}  // namespace

bool only_quads(const GoalStages& stages) {
  return stages.mesh.option("pure-quads").value() == "true";
}

std::vector<Vec3> replace_crossing(Session& session, const GoalStages& stages, const LineAim& aim,
                                   CrossingPlaces& crossing) {
  std::vector<Vec3> places = crossing.of(session.get<QuadMesh>("fitted").mesh);
  if (places.empty() || places.size() > kMostReplaced || only_quads(stages)) return places;
  Session tried = session;
  try {
    tried.run(stages.uncross);
  } catch (const AlgorithmError& error) {
    session.say(std::string("warning: kept faces that cross: ") + error.what());
    return places;
  }
  std::vector<Vec3> left = crossing.of(tried.get<QuadMesh>("uncrossed").mesh);
  const double miss = aim.miss(count_of(tried, "uncrossed", aim.counted));
  const double before = aim.miss(count_of(session, "fitted", aim.counted));
  if (left.size() >= places.size() || miss > std::max(before, kCountTolerance)) return places;
  session = tried;
  return left;
}

}  // namespace strake
