#include "common/geometry/face_crossings/penetration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/face_crossings/face_crossings.h"

namespace strake {
namespace {

using Triangle = std::array<Vec3, 3>;

/// Sine of the angle between planes that are one.
constexpr double kOnePlane = 0.0175;
/// Sine of the angle between edges whose common perpendicular rounding decides.
constexpr double kParallel = 1e-9;

Vec3 edge(const Triangle& t, int i) { return t[(i + 1) % 3] - t[i]; }

/// Length of the shortest shift along a direction of length one that parts the triangles.
double shift_along(const Vec3& direction, const Triangle& a, const Triangle& b) {
  const auto along = [&](const Vec3& p) { return direction.dot(p - a[0]); };
  const auto [low_a, high_a] = std::minmax({along(a[0]), along(a[1]), along(a[2])});
  const auto [low_b, high_b] = std::minmax({along(b[0]), along(b[1]), along(b[2])});
  return std::max(0.0, std::min(high_a - low_b, high_b - low_a));
}

}  // namespace

double penetration_depth(const Triangle& a, const Triangle& b) {
  const Vec3 normal_a = edge(a, 0).cross(edge(a, 1)).normalized();
  const Vec3 normal_b = edge(b, 0).cross(edge(b, 1)).normalized();
  // Directions normal to the faces of the Minkowski difference: one of them is the shortest.
  double depth = std::numeric_limits<double>::infinity();
  const auto try_along = [&](const Vec3& direction) {
    depth = std::min(depth, shift_along(direction, a, b));
  };
  if (normal_a.cross(normal_b).norm() < kOnePlane) {
    for (int i = 0; i < 3; ++i) {
      try_along(edge(a, i).cross(normal_a).normalized());
      try_along(edge(b, i).cross(normal_b).normalized());
    }
    return depth;
  }
  try_along(normal_a);
  try_along(normal_b);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vec3 across = edge(a, i).normalized().cross(edge(b, j).normalized());
      if (across.norm() > kParallel) try_along(across.normalized());
    }
  }
  return depth;
}

double penetration_depth(const PlacedFace& a, const PlacedFace& b) {
  double depth = 0;
  for (const Triangle& one : a.triangles) {
    for (const Triangle& other : b.triangles) {
      if (triangles_cross(one, other)) depth = std::max(depth, penetration_depth(one, other));
    }
  }
  return depth;
}

}  // namespace strake
