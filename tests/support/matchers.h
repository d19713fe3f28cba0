#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/core/types.h"

namespace strake::support {

/// The angle between two lines whose directions may have either sign, radians in [0, pi/2].
inline double line_angle(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

/// EXPECT_TRUE(near(a, b, tolerance)): the distance of two points or vectors.
inline ::testing::AssertionResult near(const Vec3& actual, const Vec3& expected, double tolerance) {
  const double distance = (actual - expected).norm();
  if (distance <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << "(" << actual.transpose() << ") is " << distance << " away from ("
         << expected.transpose() << "), allowed are " << tolerance;
}

/// EXPECT_TRUE(same_line(a, b, tolerance)): the angle of two lines, radians.
inline ::testing::AssertionResult same_line(const Vec3& actual, const Vec3& expected,
                                            double tolerance) {
  const double angle = line_angle(actual, expected);
  if (angle <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << "(" << actual.transpose() << ") is turned by " << angle << " rad against ("
         << expected.transpose() << "), allowed are " << tolerance;
}

}  // namespace strake::support
