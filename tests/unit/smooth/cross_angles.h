#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/core/fields.h"

namespace strake {

/// Angle between a direction and the nearest arm of a cross, radians in [0, pi / 4].
inline double angle_to_arm(const Vec3& arm, const Vec3& normal, const Vec3& direction) {
  const double x = std::abs(direction.dot(arm));
  const double y = std::abs(direction.dot(normal.cross(arm)));
  return std::atan2(std::min(x, y), std::max(x, y));
}

inline double angle_to_cross(const PrincipalField& field, Index w, const Vec3& direction) {
  return angle_to_arm(field.cross[w], field.normal[w], direction);
}

}  // namespace strake
