#include "stages/trace/line_progress.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "common/geometry/line_chord.h"

namespace strake {
namespace {

constexpr int kMostStanding = 4;         ///< steps that may lead nowhere
constexpr double kStandingShare = 1e-3;  ///< of a step that is none
constexpr double kLongestStay = 2;       ///< perimeters of a face that a line may run within it
/// A line looks whether it winds after so many points and own distances, or after many points.
constexpr std::size_t kPointsPerLook = 64;
constexpr double kSkipsPerLook = 2;
constexpr std::size_t kMostPointsPerLook = 256;

double perimeter(const FaceChart& face) {
  const auto& [a, b, c] = face.corner;
  return (b - a).norm() + (c - b).norm() + (a - c).norm();
}

/// Whether a half line, from a point on, crosses an edge twice within a length along it.
///
/// By what its head went: on edges much longer than that, points are moved away from vertices by
/// more than it.
bool comes_around(const TriMesh& mesh, const HalfLine& half, std::size_t from, double length) {
  std::unordered_map<Index, double> crossed;
  for (std::size_t i = from; i < half.points.size(); ++i) {
    const Index h = half.points[i].halfedge;
    const auto [last, is_new] = crossed.try_emplace(std::max(h, mesh.twin[h]), half.arcs[i]);
    if (!is_new && half.arcs[i] - last->second < length) return true;
    last->second = half.arcs[i];
  }
  return false;
}

}  // namespace

LineProgress::State LineProgress::after_step(const TriMesh& mesh, const LineHead& head,
                                             const HalfLine& half, double wanted, double moved,
                                             double own_skip) {
  const std::size_t looked_at = std::min(good_points_, half.points.size());
  const std::size_t points = half.points.size() - looked_at;
  if ((points >= kPointsPerLook && head.arc - good_arc_ >= kSkipsPerLook * own_skip) ||
      points >= kMostPointsPerLook) {
    if (comes_around(mesh, half, looked_at, own_skip)) return State::winds;
    good_points_ = half.points.size();
    good_places_ = half.crossings.all().size();
    good_arc_ = head.arc;
  }
  standing_ = moved > kStandingShare * wanted ? 0 : standing_ + 1;
  if (half.points.size() > most_points_) {
    most_points_ = half.points.size();
    arc_there_ = head.arc;
  }
  // A line that circles within a face never meets itself: it is recorded where it crosses edges.
  const bool circles = head.arc - arc_there_ > kLongestStay * perimeter(head.context.chart);
  return standing_ > kMostStanding || circles ? State::stuck : State::gets_on;
}

}  // namespace strake
