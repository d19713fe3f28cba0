#include "strake/report/thin_line.h"

#include <algorithm>

namespace strake::report {
namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0;
  return (p - a - t * along).norm();
}

}  // namespace

std::vector<std::size_t> thin_line(const std::vector<Vec3>& points,
                                   std::vector<std::uint8_t> is_fixed, double tolerance) {
  is_fixed.front() = is_fixed.back() = 1;
  std::vector<std::size_t> fixed;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_fixed[i] != 0) fixed.push_back(i);
  }
  // Runs that are still to be looked at, the first of them on top.
  std::vector<std::size_t> ends(fixed.rbegin(), fixed.rend());
  std::vector<std::size_t> kept = {0};
  ends.pop_back();
  while (!ends.empty()) {
    const std::size_t from = kept.back();
    const std::size_t to = ends.back();
    std::size_t farthest = from;
    double most = tolerance;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double distance = distance_to_segment(points[i], points[from], points[to]);
      if (distance <= most) continue;
      most = distance;
      farthest = i;
    }
    if (farthest == from) {
      kept.push_back(to);
      ends.pop_back();
    } else {
      ends.push_back(farthest);
    }
  }
  return kept;
}

}  // namespace strake::report
