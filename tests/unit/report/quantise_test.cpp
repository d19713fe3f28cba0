#include "strake/report/quantise.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "strake/report/thin_line.h"

namespace strake::report_test {
namespace {

using namespace report;

TEST(Quantise, PointsAreWithinHalfAStep) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const double size : {1e-6, 1.0, 1e9}) {
    std::vector<Vec3> points;
    for (int i = 0; i < 1000; ++i) {
      points.push_back(size * Vec3(any(random), 0.1 * any(random), 5 + 0.01 * any(random)));
    }
    const Grid grid(points);
    EXPECT_LE(grid.step(), 2 * size / 65535);
    for (const Vec3& p : points) {
      const GridPoint q = grid.quantise(p, 77);
      const Vec3 back = grid.low() + grid.step() * Vec3(q[0], q[1], q[2]);
      // Half a step, and the rounding of doubles.
      EXPECT_LE((back - p).cwiseAbs().maxCoeff(), grid.step() * 0.500001);
      EXPECT_EQ(q[3], 77);
    }
  }
}

TEST(Quantise, FlatAndSinglePointsHaveAGrid) {
  EXPECT_EQ(Grid({}).step(), 1);
  const Vec3 only(3, 4, 5);
  const Grid grid({only, only});
  EXPECT_GT(grid.step(), 0);
  EXPECT_EQ(grid.quantise(only), (GridPoint{0, 0, 0, 0}));
}

TEST(Quantise, SignedValuesAreWithinTheirBound) {
  for (double value = 1e-6; value < 1e12; value *= 1.37) {
    for (const double signed_value : {value, -value}) {
      const double back = std::sinh(quantise_signed(signed_value) / 1024.0);
      // d sinh(x) = cosh(x) dx with dx of at most half a step.
      const double bound = std::cosh(std::asinh(value) + 1.0 / 2048) / 2048;
      EXPECT_NEAR(back, signed_value, bound * 1.000001);
    }
  }
  EXPECT_EQ(quantise_signed(0), 0);
  EXPECT_EQ(quantise_signed(1e300), 32767);
  EXPECT_EQ(quantise_signed(-1e300), -32767);
}

/// The inverse, as in viewer/src/decode.js.
Vec3 direction_from(const std::array<std::int8_t, 2>& bytes) {
  double x = bytes[0] / 127.0;
  double y = bytes[1] / 127.0;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const double folded = x;
    x = (1 - std::abs(y)) * (folded < 0 ? -1 : 1);
    y = (1 - std::abs(folded)) * (y < 0 ? -1 : 1);
  }
  return Vec3(x, y, z).normalized();
}

TEST(Quantise, DirectionsAreWithinADegree) {
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  std::vector<Vec3> directions = {Vec3::UnitX(),  Vec3::UnitY(),  Vec3::UnitZ(),
                                  -Vec3::UnitX(), -Vec3::UnitY(), -Vec3::UnitZ()};
  for (int i = 0; i < 5000; ++i) {
    directions.push_back(Vec3(any(random), any(random), any(random)).normalized());
  }
  for (const Vec3& d : directions) {
    const Vec3 back = direction_from(quantise_direction(d));
    const double angle = std::atan2(d.cross(back).norm(), d.dot(back)) * 180 / std::numbers::pi;
    EXPECT_LE(angle, 1) << d.transpose();
  }
}

TEST(ThinLine, KeepsWhatIsFixedAndStaysWithinItsTolerance) {
  std::mt19937 random(4);
  std::normal_distribution<double> step;
  std::vector<Vec3> points = {Vec3::Zero()};
  for (int i = 0; i < 2000; ++i) {
    points.push_back(points.back() + Vec3(1, 0.2 * step(random), 0.2 * step(random)));
  }
  std::vector<std::uint8_t> is_fixed(points.size(), 0);
  is_fixed[777] = 1;
  const double tolerance = 1.5;
  const auto kept = thin_line(points, is_fixed, tolerance);
  EXPECT_LT(kept.size(), points.size() / 2);
  EXPECT_EQ(kept.front(), 0u);
  EXPECT_EQ(kept.back(), points.size() - 1);
  EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), 777u));
  for (std::size_t k = 1; k < kept.size(); ++k) {
    ASSERT_LT(kept[k - 1], kept[k]);
    const Vec3& a = points[kept[k - 1]];
    const Vec3 along = points[kept[k]] - a;
    for (std::size_t i = kept[k - 1]; i <= kept[k]; ++i) {
      const double t = std::clamp((points[i] - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      EXPECT_LE((points[i] - a - t * along).norm(), tolerance * 1.000001);
    }
  }
}

TEST(ThinLine, StraightAndClosedLines) {
  const std::vector<Vec3> straight = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}};
  EXPECT_EQ(thin_line(straight, {0, 0, 0, 0}, 1e-9), (std::vector<std::size_t>{0, 3}));
  const std::vector<Vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(thin_line(square, {0, 0, 0, 0, 0}, 1e-9), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(thin_line({Vec3::Zero()}, {0}, 1), (std::vector<std::size_t>{0}));
}

}  // namespace
}  // namespace strake::report_test
