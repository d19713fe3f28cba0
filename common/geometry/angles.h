#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/core/types.h"

namespace strake {

constexpr double kDegree = std::numbers::pi / 180;  ///< radians
/// A line that turns by more than this has a corner there, radians.
constexpr double kSharpTurn = 50 * kDegree;

/// The angle between two ways of any lengths, radians in [0, pi]; exact for small angles and for
/// those near pi, too. 0 where one of them has no length.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The smallest angle of a triangle, radians in [0, pi / 3].
inline double smallest_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::min(
      {angle_between(b - a, c - a), angle_between(c - b, a - b), angle_between(a - c, b - c)});
}

}  // namespace strake
