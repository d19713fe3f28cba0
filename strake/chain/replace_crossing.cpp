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

}  // namespace

bool only_quads(const GoalStages& stages) {
  return stages.mesh.option("pure-quads").value() == "true";
}

std::vector<Vec3> replace_crossing(Session& session, const GoalStages& stages, const LineAim& aim,
                                   CrossingPlaces& crossing) {
  const PolyMesh& faces = session.get<QuadMesh>("fitted").mesh;
  std::vector<Vec3> places = crossing.of(faces);
  if (places.empty() || only_quads(stages)) return places;
  const double share = static_cast<double>(places.size()) / faces.face_count();
  if (places.size() > kMostReplaced || share > kMostReplacedShare) return places;
  if (crossing.is_stacked()) return places;
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
