#include "tests/support/analytic_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/matchers.h"
#include "tests/support/mesh_support.h"

namespace strake::support {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<SampleKind> analytic_kinds() {
  return {SampleKind::plane, SampleKind::sphere,    SampleKind::open_cylinder,
          SampleKind::torus, SampleKind::ellipsoid, SampleKind::hyperboloid,
          SampleKind::saddle};
}

TriMesh sample(SampleKind kind, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return plain_tri_mesh(make_sample(kind, options));
}

class AnalyticSurfaces : public ::testing::TestWithParam<SampleKind> {};

INSTANTIATE_TEST_SUITE_P(All, AnalyticSurfaces, ::testing::ValuesIn(analytic_kinds()),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

TEST_P(AnalyticSurfaces, CurvaturesAreTheDerivativesOfTheNormal) {
  const AnalyticSurface surface = analytic_surface(GetParam());
  const double step = 1e-4;
  for (const Vec3& p : sample(GetParam(), 1000).positions) {
    const ExactCurvature c = surface.at(p);
    EXPECT_NEAR(c.normal.norm(), 1, 1e-14);
    EXPECT_NEAR(c.normal.dot(c.t_min), 0, 1e-14);
    EXPECT_NEAR(c.normal.dot(c.t_max), 0, 1e-14);
    EXPECT_NEAR(c.t_min.dot(c.t_max), 0, 1e-14);
    EXPECT_LE(std::abs(c.k_min), std::abs(c.k_max));
    for (const auto& [k, t] : {std::pair(c.k_min, c.t_min), std::pair(c.k_max, c.t_max)}) {
      // Central differences are off by step^2 / 6 times third derivatives of the surface, which
      // are below 1/0.4^3 times a small factor here; rounding adds 1e-16 / step.
      const Vec3 turn =
          (surface.at(p + step * t).normal - surface.at(p - step * t).normal) / (2 * step);
      EXPECT_TRUE(near(turn, k * t, 1e-6));
    }
  }
}

TEST_P(AnalyticSurfaces, FootIsOnTheSurfaceStraightBelow) {
  const AnalyticSurface surface = analytic_surface(GetParam());
  for (const Vec3& p : sample(GetParam(), 500).positions) {
    const ExactCurvature on = surface.at(p);
    const double height = 1e-5;
    const ExactCurvature above = surface.at(p + height * on.normal);
    EXPECT_NEAR(surface.offset(above.foot), 0, 1e-15);
    // Newton's steps follow the gradient, which turns within the height: second order.
    EXPECT_TRUE(near(above.foot, on.foot, 100 * height * height));
  }
}

TEST_P(AnalyticSurfaces, LineCoordinatesStandStillAlongTheLines) {
  const AnalyticSurface surface = analytic_surface(GetParam());
  if (!surface.lines(surface.at(Vec3(0.3, 0.2, 0.1)).foot)) {
    EXPECT_TRUE(GetParam() == SampleKind::plane || GetParam() == SampleKind::sphere ||
                GetParam() == SampleKind::saddle);
    return;
  }
  const double step = 1e-4;
  Index judged = 0;
  for (const Vec3& p : sample(GetParam(), 1000).positions) {
    const ExactCurvature c = surface.at(p);
    if (c.anisotropy() < 0.05) continue;  // near umbilics confocal coordinates have square roots
    ++judged;
    const auto rates = [&](const Vec3& t) -> Vec2 {
      const auto a = *surface.lines(surface.at(p + step * t).foot);
      const auto b = *surface.lines(surface.at(p - step * t).foot);
      return Vec2(std::remainder(a.along_min - b.along_min, 2 * kPi),
                  std::remainder(a.along_max - b.along_max, 2 * kPi)) /
             (2 * step);
    };
    EXPECT_NEAR(rates(c.t_min)[0], 0, 1e-4);
    EXPECT_NEAR(rates(c.t_max)[1], 0, 1e-4);
  }
  EXPECT_GT(judged, 100);
}

TEST(AnalyticCurvature, MatchesTheTextbook) {
  const ExactCurvature sphere =
      analytic_surface(SampleKind::sphere).at(Vec3(0.48, 0.6, 0.64) * kSphereRadius);
  EXPECT_NEAR(sphere.k_min, 1 / kSphereRadius, 1e-14);
  EXPECT_NEAR(sphere.k_max, 1 / kSphereRadius, 1e-14);
  EXPECT_TRUE(sphere.umbilic);

  const ExactCurvature cylinder =
      analytic_surface(SampleKind::cylinder).at(Vec3(0, kCylinderRadius, 0.5));
  EXPECT_NEAR(cylinder.k_min, 0, 1e-14);
  EXPECT_NEAR(cylinder.k_max, 1 / kCylinderRadius, 1e-14);
  EXPECT_FALSE(cylinder.umbilic);
  EXPECT_TRUE(same_line(cylinder.t_min, Vec3::UnitZ(), 1e-14));

  const AnalyticSurface torus = analytic_surface(SampleKind::torus);
  const double outer = kTorusMajorRadius + kTorusMinorRadius;
  const double inner = kTorusMajorRadius - kTorusMinorRadius;
  EXPECT_NEAR(torus.at(Vec3(outer, 0, 0)).k_min, 1 / outer, 1e-14);
  EXPECT_NEAR(torus.at(Vec3(inner, 0, 0)).k_min, -1 / inner, 1e-14);
  EXPECT_NEAR(torus.at(Vec3(inner, 0, 0)).k_max, 1 / kTorusMinorRadius, 1e-14);
  EXPECT_TRUE(same_line(torus.at(Vec3(outer, 0, 0)).t_min, Vec3::UnitY(), 1e-14));

  const AnalyticSurface saddle = analytic_surface(SampleKind::saddle);
  const ExactCurvature middle = saddle.at(Vec3::Zero());
  EXPECT_NEAR(middle.k_min, -middle.k_max, 1e-14);
  EXPECT_NEAR(std::abs(middle.k_max), 2 * kSaddleBend, 1e-14);
  EXPECT_FALSE(middle.umbilic);
  EXPECT_NEAR(middle.anisotropy(), 0, 1e-14);
  // Upward normal: the x section rises away from the tangent plane towards it, hence concave.
  const Vec3 x = std::abs(middle.t_min.x()) > 0.5 ? middle.t_min : middle.t_max;
  EXPECT_NEAR(x.dot(Vec3::UnitX()) > 0.5 || x.dot(-Vec3::UnitX()) > 0.5, true, 0);
  const double k_x = std::abs(middle.t_min.x()) > 0.5 ? middle.k_min : middle.k_max;
  EXPECT_NEAR(k_x, -2 * kSaddleBend, 1e-14);
}

TEST(AnalyticCurvature, EllipsoidIsUmbilicWhereDupinSays) {
  const double a2 = kEllipsoidAxes[0] * kEllipsoidAxes[0],
               b2 = kEllipsoidAxes[1] * kEllipsoidAxes[1],
               c2 = kEllipsoidAxes[2] * kEllipsoidAxes[2];
  const Vec3 umbilic(std::sqrt(a2 * (a2 - b2) / (a2 - c2)), 0,
                     std::sqrt(c2 * (b2 - c2) / (a2 - c2)));
  const AnalyticSurface surface = analytic_surface(SampleKind::ellipsoid);
  EXPECT_TRUE(surface.at(umbilic).umbilic);
  EXPECT_FALSE(surface.at(Vec3(kEllipsoidAxes[0], 0, 0)).umbilic);
  // There k = a b / c^2 ... in general a / b^2 and a / c^2 at the tip of axis a.
  EXPECT_NEAR(surface.at(Vec3(kEllipsoidAxes[0], 0, 0)).k_min, kEllipsoidAxes[0] / b2, 1e-13);
  EXPECT_NEAR(surface.at(Vec3(kEllipsoidAxes[0], 0, 0)).k_max, kEllipsoidAxes[0] / c2, 1e-13);
}

TEST(AnalyticCurvature, IntegralOfGaussianCurvatureIsTheEulerCharacteristic) {
  for (const auto& [kind, euler] :
       {std::pair(SampleKind::sphere, 2), std::pair(SampleKind::ellipsoid, 2),
        std::pair(SampleKind::torus, 0)}) {
    const AnalyticSurface surface = analytic_surface(kind);
    const TriMesh mesh = sample(kind, 30000);
    const std::vector<double> area = vertex_areas(mesh);
    double integral = 0, absolute = 0, sharpest = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const ExactCurvature c = surface.at(mesh.positions[v]);
      integral += c.k_min * c.k_max * area[v];
      absolute += std::abs(c.k_min * c.k_max) * area[v];
      sharpest = std::max(sharpest, std::abs(c.k_max));
    }
    // Sums over vertices and chord areas are of second order in h k.
    const double h = mean_edge_length(mesh);
    EXPECT_NEAR(integral, 2 * kPi * euler, h * h * sharpest * sharpest * absolute);
  }
}

}  // namespace
}  // namespace strake::support
