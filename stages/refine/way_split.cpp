#include "stages/refine/way_split.h"

#include <algorithm>
#include <array>

namespace strake {
namespace {

/// Corners within this share of the length from the ends are no good places.
constexpr double kLeastShare = 0.25;
/// The middle is good enough where it is at least this share of the largest distance away.
constexpr double kNearlyFarthest = 0.8;

double distance_to_chord(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 chord = b - a;
  const double square = chord.squaredNorm();
  const double share = square > 0 ? std::clamp((p - a).dot(chord) / square, 0.0, 1.0) : 0;
  return (p - (a + share * chord)).norm();
}

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
    return distance_to_chord(p, places.front(), places.back());
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

std::vector<std::size_t> corners_of_way(const std::vector<Vec3>& places, double within) {
  std::vector<std::size_t> corners;
  std::vector<std::array<std::size_t, 2>> parts;
  if (places.size() > 2) parts.push_back({0, places.size() - 1});
  while (!parts.empty()) {
    const auto [first, last] = parts.back();
    parts.pop_back();
    std::size_t farthest = first;
    double height = within;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double now = distance_to_chord(places[i], places[first], places[last]);
      if (now <= height) continue;
      height = now;
      farthest = i;
    }
    if (farthest == first) continue;
    corners.push_back(farthest);
    parts.push_back({first, farthest});
    parts.push_back({farthest, last});
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

double height_of_way(const std::vector<Vec3>& places) {
  double height = 0;
  for (const Vec3& p : places) {
    height = std::max(height, distance_to_chord(p, places.front(), places.back()));
  }
  return height;
}

}  // namespace strake
