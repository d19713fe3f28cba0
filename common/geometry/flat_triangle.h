#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/core/types.h"

namespace strake {

/// Height of a face, in longest sides, up to which it has no area: much above what rounding of
/// coordinates leaves of none.
inline constexpr double kFlatHeight = 1e-9;

/// Whether a triangle has no area, so that nobody sees it: where another one does not cover the
/// same place there is nothing.
/// \return true, too, where a coordinate is no finite number
inline bool is_flat_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest2 =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  const double twice_area = (b - a).cross(c - a).norm();
  return !(twice_area > kFlatHeight * longest2) || !std::isfinite(twice_area);
}

}  // namespace strake
