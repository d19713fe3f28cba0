#include "stages/refine/edges_across_bend.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace strake {
namespace {

/// Heights below this share of what a cell is off by do not explain it.
constexpr double kExplains = 0.25;

/// The corner that turns least: of a pentagon the one at which a line ends.
std::size_t straightest_corner(std::span<const Vec3> corners) {
  const std::size_t n = corners.size();
  std::size_t best = 0;
  double least = 2;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = corners[i];
    const Vec3 ahead = corners[(i + 1) % n] - p;
    const Vec3 back = corners[(i + n - 1) % n] - p;
    const double cosine = ahead.normalized().dot(back.normalized());
    if (cosine >= least) continue;
    least = cosine;
    best = i;
  }
  return best;
}

}  // namespace

std::vector<std::size_t> edges_across_bend(std::span<const Vec3> corners, const Mat3& bend,
                                           double distance) {
  const std::size_t n = corners.size();
  const auto side = [&](std::size_t i) { return Vec3(corners[(i + 1) % n] - corners[i % n]); };
  // Whether to cut across direction a rather than across direction b.
  const auto across_first = [&](const Vec3& a, const Vec3& b) {
    const double height_a = std::abs(a.dot(bend * a)) / 4;
    const double height_b = std::abs(b.dot(bend * b)) / 4;
    if (std::max(height_a, height_b) < kExplains * distance) {
      return a.squaredNorm() >= b.squaredNorm();
    }
    return height_a >= height_b;
  };
  if (n == 4) {
    const Vec3 a = (side(0) - side(2)) / 2;
    const Vec3 b = (side(1) - side(3)) / 2;
    return across_first(a, b) ? std::vector<std::size_t>{0, 2} : std::vector<std::size_t>{1, 3};
  }
  if (n > 5) return {0, n / 2};
  const std::size_t t = straightest_corner(corners);
  const Vec3 opposite = side(t + 2);
  const Vec3 beside = (side(t + 1) - side(t + 3)) / 2;
  if (across_first(opposite, beside)) return {(t + 2) % n};
  return {(t + 1) % n, (t + 3) % n};
}

}  // namespace strake
