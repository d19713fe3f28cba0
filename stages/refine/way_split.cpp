#include "stages/refine/way_split.h"

#include <algorithm>

#include "common/geometry/segment.h"

namespace strake {
namespace {

/// Corners within this share of the length from the ends are no good places.
constexpr double kLeastShare = 0.25;
/// The middle is good enough where it is at least this share of the largest distance away.
constexpr double kNearlyFarthest = 0.8;

}  // namespace

WayPlace split_of_way(const std::vector<Vec3>& places) {
  const std::size_t pieces = places.size() - 1;
  std::vector<double> until = {0};  // length up to each place
  for (std::size_t i = 0; i < pieces; ++i) {
    until.push_back(until.back() + (places[i + 1] - places[i]).norm());
  }
  const double length = until.back();
  WayPlace middle;
  while (until[middle.piece + 1] < length / 2 && middle.piece + 1 < pieces) ++middle.piece;
  const double piece = until[middle.piece + 1] - until[middle.piece];
  if (piece > 0) {
    middle.share = std::clamp((length / 2 - until[middle.piece]) / piece, 0.0, 1.0);
  }
  const auto distance = [&](const Vec3& p) {
    return way_to_segment(p, places.front(), places.back()).norm();
  };
  const Vec3& start = places[middle.piece];
  double largest =
      distance(start + middle.share * (places[middle.piece + 1] - start)) / kNearlyFarthest;
  WayPlace best = middle;
  for (std::size_t i = 1; i < pieces; ++i) {
    const bool is_amid = until[i] >= kLeastShare * length && until[i] <= (1 - kLeastShare) * length;
    if (!is_amid || !(distance(places[i]) > largest)) continue;
    largest = distance(places[i]);
    best = {i, 0};
  }
  return best;
}

double height_of_way(const std::vector<Vec3>& places) {
  double height = 0;
  for (const Vec3& p : places) {
    height = std::max(height, way_to_segment(p, places.front(), places.back()).norm());
  }
  return height;
}

}  // namespace strake
