#include "strake/chain/replace_crossing.h"

#include <algorithm>
#include <string>

#include "common/core/error.h"

namespace strake {
namespace {

/// Faces that cross, and their share of all, up to which the input's own are tried in their place
/// for a count. Where more do the shape is too fine for its cells nearly everywhere, and what would
/// take their place is most of the surface.
constexpr std::size_t kMostReplaced = 1000;
constexpr double kMostReplacedShare = 0.05;

/// Share of all faces that may touch others for these to be replaced where none crosses. Of about
/// as many faces no quads come, which is seen along an edge; that it is divided differently in two
/// sheets is not.
constexpr double kMostTouchingShare = 0.01;

/// Whether fewer faces cross, or as many and none touches any more: sheets that are divided alike
/// in parts of an edge cannot be joined there either.
bool is_better(const MeetingFaces& left, const MeetingFaces& before) {
  if (left.crossing.size() != before.crossing.size()) {
    return left.crossing.size() < before.crossing.size();
  }
  return left.all.size() < before.all.size() && left.all.size() == left.crossing.size();
}

}  // namespace

bool only_quads(const GoalStages& stages) {
  return stages.mesh.option("pure-quads").value() == "true";
}

std::vector<Vec3> replace_crossing(Session& session, const GoalStages& stages, const LineAim& aim,
                                   CrossingPlaces& crossing) {
  const PolyMesh& before = session.get<QuadMesh>("fitted").mesh;
  const MeetingFaces met = crossing.meeting(before);
  std::vector<Vec3> places = crossing.middles(before, met.crossing);
  if (met.all.empty() || only_quads(stages)) return places;
  const double share = static_cast<double>(met.all.size()) / before.face_count();
  const double most = met.crossing.empty() ? kMostTouchingShare : kMostReplacedShare;
  if (met.all.size() > kMostReplaced || share > most) return places;
  if (crossing.is_stacked()) return places;
  Session tried = session;
  try {
    tried.run(stages.uncross);
  } catch (const AlgorithmError& error) {
    session.say(std::string("warning: kept faces that cross: ") + error.what());
    return places;
  }
  const PolyMesh& after = tried.get<QuadMesh>("uncrossed").mesh;
  const MeetingFaces left = crossing.meeting(after);
  const double miss = aim.miss(count_of(tried, "uncrossed", aim.counted));
  const double miss_before = aim.miss(count_of(session, "fitted", aim.counted));
  if (!is_better(left, met) || miss > std::max(miss_before, kCountTolerance)) return places;
  places = crossing.middles(after, left.crossing);
  session = tried;
  return places;
}

}  // namespace strake
