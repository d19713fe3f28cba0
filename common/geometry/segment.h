#pragma once

#include <algorithm>

#include "common/core/types.h"

namespace strake {

/// From p to the nearest point of segment a-b, which may be a point.
inline Vec3 way_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0.0;
  return a + t * d - p;
}

}  // namespace strake
