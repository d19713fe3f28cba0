#include "common/geometry/face_crossings/penetration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

#include "common/geometry/face_crossings/face_crossings.h"

namespace strake {
namespace {

using Triangle = std::array<Vec3, 3>;

const Triangle kFloor = {Vec3(-2, -2, 0), Vec3(2, -2, 0), Vec3(0, 3, 0)};

/// Upright over the middle of the floor.
Triangle upright(double lowest) {
  return {Vec3(-0.5, 0, lowest), Vec3(0.5, 0, lowest), Vec3(0, 0, lowest + 1)};
}

Triangle shifted(Triangle t, const Vec3& by) {
  for (Vec3& p : t) p += by;
  return t;
}

TEST(Penetration, IsHowFarATriangleStandsBelowAnother) {
  EXPECT_EQ(penetration_depth(kFloor, upright(0)), 0);
  for (const double depth : {1e-9, 1e-3, 0.3}) {
    EXPECT_NEAR(penetration_depth(kFloor, upright(-depth)), depth, 1e-15);
    EXPECT_NEAR(penetration_depth(upright(-depth), kFloor), depth, 1e-15);
  }
  EXPECT_NEAR(penetration_depth(kFloor, upright(-0.9)), 0.1, 1e-15);  // up is the longer way
}

// What is turned over onto its neighbours in a plane is no thinner for that.
TEST(Penetration, IsAlongThePlaneOfTrianglesOnTopOfEachOther) {
  const Triangle right = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_NEAR(penetration_depth(right, shifted(right, Vec3(0.75, 0, 0))), 0.25 / std::sqrt(2.0),
              1e-15);
  const Triangle beside = {Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(0.3, -1, 0)};
  EXPECT_EQ(penetration_depth(right, beside), 0);
}

TEST(Penetration, NoShorterShiftPartsTriangles) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto point = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  int crossing = 0;
  for (int i = 0; i < 400; ++i) {
    const Triangle a = {point(), point(), point()};
    const Triangle b = {point(), point(), point()};
    if (!triangles_cross(a, b)) continue;
    ++crossing;
    const double depth = penetration_depth(a, b);
    EXPECT_GT(depth, 0);
    for (int k = 0; k < 20; ++k) {
      EXPECT_TRUE(triangles_cross(a, shifted(b, 0.99 * depth * point().normalized())));
    }
  }
  EXPECT_GT(crossing, 50);
}

TEST(Penetration, ScalesAndTurnsWithTheTriangles) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, -1).normalized());
  const auto moved = [&](Triangle t) {
    for (Vec3& p : t) p = 100 * (turn * p) + Vec3(3, -4, 5);
    return t;
  };
  // Coordinates of some hundreds: rounding of 1e-13.
  EXPECT_NEAR(penetration_depth(moved(kFloor), moved(upright(-0.3))), 30, 1e-12);
  EXPECT_NEAR(penetration_depth(moved(kFloor), moved(upright(0))), 0, 1e-12);
}

}  // namespace
}  // namespace strake
