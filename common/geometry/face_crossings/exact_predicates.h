#pragma once

#include "common/core/types.h"

namespace strake {

/// Sign of the volume of (a, b, c, d): 1 where d sees a, b, c run clockwise, -1 where
/// counter-clockwise, 0 where the four lie in a plane.
///
/// Exact for coordinates whose triple products neither overflow nor vanish (|x| within 1e-90 and
/// 1e100, or 0): doubles with a bound on their error first, then sums without rounding. Source:
/// J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Sign of the area of a triangle in the plane: 1 where a, b, c run counter-clockwise. As exact.
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace strake
