#include "common/geometry/frames.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/matchers.h"

namespace strake {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

class Frames : public ::testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }
  Vec2 plane_direction() {
    const double angle = uniform(-M_PI, M_PI);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  std::mt19937_64 random_{7};
};

TEST_F(Frames, TangentFrameIsRightHandedAndOrthonormal) {
  std::vector<Vec3> normals = {Vec3::UnitZ(), -Vec3::UnitZ(), Vec3::UnitX(), -Vec3::UnitY(),
                               Vec3(1e-9, 0, -1).normalized()};
  for (int i = 0; i < 200; ++i) normals.push_back(direction());
  for (const Vec3& n : normals) {
    const TangentFrame frame = tangent_frame(n);
    EXPECT_NEAR(frame.x.norm(), 1, 8 * kEps);
    EXPECT_NEAR(frame.x.dot(n), 0, 8 * kEps);
    EXPECT_TRUE(support::near(n.cross(frame.x), frame.y, 16 * kEps));
    const Vec2 t(0.3, -0.7);
    EXPECT_NEAR((frame.tangent_from_world(frame.world_from_tangent(t)) - t).norm(), 0, 16 * kEps);
  }
}

TEST_F(Frames, RotateBetweenIsTheRotationThatTakesOneVectorToTheOther) {
  for (int i = 0; i < 500; ++i) {
    const Vec3 from = direction();
    const Vec3 to = direction();
    const double cosine = from.dot(to);
    const double tolerance = 32 * kEps / (1 + cosine);  // what 1 / (1 + c) does to rounding
    EXPECT_TRUE(support::near(rotate_between(from, to, from), to, tolerance));
    const Vec3 axis = from.cross(to);
    EXPECT_TRUE(support::near(rotate_between(from, to, axis), axis, tolerance)) << "axis fixed";
    const Vec3 v = direction();
    const Vec3 w = direction();
    const Vec3 rv = rotate_between(from, to, v);
    const Vec3 rw = rotate_between(from, to, w);
    EXPECT_NEAR(rv.dot(rw), v.dot(w), tolerance);
    EXPECT_TRUE(
        support::near(rotate_between(from, to, Vec3(v.cross(w))), rv.cross(rw), 4 * tolerance));
  }
}

TEST_F(Frames, RotateBetweenEqualOrOppositeVectorsChangesNothing) {
  for (int i = 0; i < 50; ++i) {
    const Vec3 n = direction();
    const Vec3 v = direction();
    EXPECT_TRUE(support::near(rotate_between(n, n, v), v, 8 * kEps));
    EXPECT_TRUE(support::near(rotate_between(n, -n, v), v, 0));
  }
}

TEST_F(Frames, CrossPowerIsTheSameForAllArmsAndLengths) {
  for (int i = 0; i < 200; ++i) {
    const Vec2 d = plane_direction();
    const std::complex<double> power = cross_power(d);
    EXPECT_NEAR(std::abs(power), 1, 8 * kEps);
    EXPECT_NEAR(std::abs(cross_power(Vec2(-d.y(), d.x())) - power), 0, 16 * kEps);
    EXPECT_NEAR(std::abs(cross_power(-1e-5 * d) - power), 0, 16 * kEps);
    // An eighth of a turn apart is as far as two crosses can be.
    const Vec2 turned = (d + Vec2(-d.y(), d.x())).normalized();
    EXPECT_NEAR(std::abs(cross_power(turned) + power), 0, 32 * kEps);
  }
  EXPECT_EQ(cross_power(Vec2::Zero()), std::complex<double>(0, 0));
}

TEST_F(Frames, CrossArmIsTheArmNearestToTheReference) {
  for (int i = 0; i < 500; ++i) {
    const Vec2 d = plane_direction();
    const Vec2 reference = uniform(0.01, 100) * plane_direction();
    const Vec2 arm = cross_arm(uniform(0.1, 3) * cross_power(d), reference);
    EXPECT_NEAR(arm.norm(), 1, 8 * kEps);
    double best = -1;
    Vec2 nearest = d;
    for (const Vec2& a : {d, Vec2(-d.y(), d.x()), Vec2(-d), Vec2(d.y(), -d.x())}) {
      if (a.dot(reference) > best) {
        best = a.dot(reference);
        nearest = a;
      }
    }
    EXPECT_NEAR((arm - nearest).norm(), 0, 32 * kEps);
  }
}

/// Compares with Eigen's solver. The entries are known to kEps of the norm, so eigenvalues can
/// agree to a few kEps of it, and the direction has a residual of that size.
void expect_eigen_solution(double xx, double xy, double yy) {
  SCOPED_TRACE(::testing::Message() << "[" << xx << " " << xy << " " << yy << "]");
  Mat2 m;
  m << xx, xy, xy, yy;
  const double scale = m.cwiseAbs().maxCoeff();
  ASSERT_GT(scale, 0);
  const Mat2 unit = m / scale;  // Eigen squares entries
  const Eigen::SelfAdjointEigenSolver<Mat2> solver(unit);
  Vec2 expected = solver.eigenvalues();
  if (std::abs(expected[0]) < std::abs(expected[1])) std::swap(expected[0], expected[1]);
  const Eigen2 actual = eigen_symmetric2(xx, xy, yy);
  const double larger = actual.larger / scale;
  const double smaller = actual.smaller / scale;
  EXPECT_GE(std::abs(larger), std::abs(smaller));
  EXPECT_NEAR(std::abs(larger), std::abs(expected[0]), 16 * kEps);
  EXPECT_NEAR(larger + smaller, unit.trace(), 16 * kEps);
  EXPECT_NEAR(larger * smaller, unit.determinant(), 64 * kEps);
  const Vec2& d = actual.direction_of_larger;
  EXPECT_NEAR(d.norm(), 1, 8 * kEps);
  EXPECT_NEAR((unit * d - larger * d).norm(), 0, 32 * kEps);
}

TEST_F(Frames, EigenSolutionAgreesWithEigenAtEveryScale) {
  for (const double scale : {1e-300, 1e-150, 1e-8, 1.0, 1e8, 1e150, 1e300}) {
    for (int i = 0; i < 200; ++i) {
      expect_eigen_solution(scale * uniform(-1, 1), scale * uniform(-1, 1), scale * uniform(-1, 1));
    }
    // Of very different magnitudes.
    expect_eigen_solution(scale, 1e-12 * scale, 1e-3 * scale);
    expect_eigen_solution(1e-12 * scale, scale, 1e-12 * scale);
    expect_eigen_solution(-scale, 1e-9 * scale, 1e-15 * scale);
  }
}

TEST_F(Frames, EigenSolutionOfDegenerateMatrices) {
  // Equal or opposite eigenvalues, rank one, and a hair beside them.
  for (int i = 0; i < 100; ++i) {
    const Vec2 d = plane_direction();
    const double hair = std::pow(10, uniform(-17, -6));
    for (const double second : {0.0, 1.0, -1.0, 1 + hair, -1 + hair, hair}) {
      const Vec2 e(-d.y(), d.x());
      const Mat2 m = d * d.transpose() + second * e * e.transpose();
      expect_eigen_solution(m(0, 0), m(0, 1), m(1, 1));
    }
  }
  for (const double value : {0.0, 2.5, -3.0, 1e-310, 1e300}) {
    const Eigen2 isotropic = eigen_symmetric2(value, 0, value);
    EXPECT_EQ(isotropic.larger, value);
    EXPECT_EQ(isotropic.smaller, value);
    EXPECT_EQ(isotropic.direction_of_larger, Vec2(1, 0));
  }
}

}  // namespace
}  // namespace strake
