#include "tests/support/analytic_surfaces.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace strake::support {
namespace {

/// sum of weights_i p_i^2 - 1 = 0.
ImplicitValue central_quadric(const Vec3& weights, const Vec3& p) {
  return {weights.dot(p.cwiseProduct(p)) - 1, 2 * weights.cwiseProduct(p),
          2 * Mat3(weights.asDiagonal())};
}

AnalyticSurface plane() {
  return AnalyticSurface([](const Vec3& p) {
    return ImplicitValue{p.z(), Vec3::UnitZ(), Mat3::Zero()};
  });
}

/// x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 with a >= b >= c.
AnalyticSurface ellipsoid(const Vec3& axes) {
  const Vec3 squares = axes.cwiseProduct(axes);
  const auto implicit = [=](const Vec3& p) { return central_quadric(squares.cwiseInverse(), p); };
  if (axes.x() == axes.z()) return AnalyticSurface(implicit);
  // Confocal coordinates (Dupin): besides 0, the roots l of sum x_i^2 / (a_i^2 - l) = 1. On the
  // ellipsoid l^3 - s l^2 + q l = 0 is left of it. The curvature along the line where only l_i
  // varies is a b c / (l_i^(3/2) l_j^(1/2)): the smaller root varies along maximum lines.
  const auto lines = [=](const Vec3& p) {
    const Vec3 p2 = p.cwiseProduct(p);
    const double s = squares.sum() - p2.sum();
    const double q = squares.x() * squares.y() + squares.y() * squares.z() +
                     squares.z() * squares.x() - p2.x() * (squares.y() + squares.z()) -
                     p2.y() * (squares.z() + squares.x()) - p2.z() * (squares.x() + squares.y());
    const double root = std::sqrt(std::max(0.0, s * s / 4 - q));
    return LineCoordinates{s / 2 - root, s / 2 + root};
  };
  return AnalyticSurface(implicit, lines);
}

AnalyticSurface cylinder(double radius) {
  const double weight = 1 / (radius * radius);
  return AnalyticSurface([=](const Vec3& p) { return central_quadric(Vec3(weight, weight, 0), p); },
                         [](const Vec3& p) {
                           return LineCoordinates{std::atan2(p.y(), p.x()), p.z()};
                         });
}

AnalyticSurface torus(double major, double minor) {
  const auto implicit = [=](const Vec3& p) {
    const double rho = p.head<2>().norm();
    const Vec3 out(p.x() / rho, p.y() / rho, 0), around(-out.y(), out.x(), 0);
    const double d = rho - major;
    return ImplicitValue{d * d + p.z() * p.z() - minor * minor,
                         2 * d * out + 2 * p.z() * Vec3::UnitZ(),
                         2 * (out * out.transpose() + d / rho * around * around.transpose() +
                              Vec3::UnitZ() * Vec3::UnitZ().transpose())};
  };
  // The tube is bent by 1 / minor, more than the circles around the axis anywhere.
  const auto lines = [=](const Vec3& p) {
    return LineCoordinates{std::atan2(p.z(), p.head<2>().norm() - major), std::atan2(p.y(), p.x())};
  };
  return AnalyticSurface(implicit, lines);
}

/// With these dimensions the circles are bent more than the meridians, everywhere.
AnalyticSurface hyperboloid(double waist, double slope) {
  const double w = 1 / (waist * waist);
  return AnalyticSurface(
      [=](const Vec3& p) { return central_quadric(Vec3(w, w, -1 / (slope * slope)), p); },
      [](const Vec3& p) {
        return LineCoordinates{std::atan2(p.y(), p.x()), p.z()};
      });
}

AnalyticSurface saddle(double bend) {
  return AnalyticSurface([=](const Vec3& p) {
    return ImplicitValue{p.z() - bend * (p.x() * p.x() - p.y() * p.y()),
                         Vec3(-2 * bend * p.x(), 2 * bend * p.y(), 1),
                         Mat3(Vec3(-2 * bend, 2 * bend, 0).asDiagonal())};
  });
}

}  // namespace

double ExactCurvature::anisotropy() const {
  const double sum = std::abs(k_max) + std::abs(k_min);
  return sum > 0 ? (std::abs(k_max) - std::abs(k_min)) / sum : 0;
}

ExactCurvature AnalyticSurface::at(const Vec3& p) const {
  Vec3 foot = p;
  for (int step = 0; step < 20; ++step) {
    const ImplicitValue f = implicit_(foot);
    const Vec3 correction = f.value / f.gradient.squaredNorm() * f.gradient;
    foot -= correction;
    if (correction.norm() <= 1e-16 * foot.norm()) break;
  }
  const ImplicitValue f = implicit_(foot);
  const double slope = f.gradient.norm();
  const Vec3 normal = f.gradient / slope;
  // The derivative of the unit normal within the tangent plane.
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  Mat2 shape;
  shape << u.dot(f.hessian * u), u.dot(f.hessian * v), v.dot(f.hessian * u), v.dot(f.hessian * v);
  const Eigen::SelfAdjointEigenSolver<Mat2> solver(shape / slope);
  const auto direction = [&](int i) {
    const Vec2 e = solver.eigenvectors().col(i);
    return Vec3(e.x() * u + e.y() * v);
  };
  const double k0 = solver.eigenvalues()[0], k1 = solver.eigenvalues()[1];
  const bool first_is_min = std::abs(k0) <= std::abs(k1);
  const int min = first_is_min ? 0 : 1;
  const bool umbilic = k1 - k0 <= 1e-9 * (std::abs(k0) + std::abs(k1));
  return {foot,
          normal,
          first_is_min ? k0 : k1,
          first_is_min ? k1 : k0,
          direction(min),
          direction(1 - min),
          umbilic};
}

double AnalyticSurface::offset(const Vec3& p) const {
  const ImplicitValue f = implicit_(p);
  return f.value / f.gradient.norm();
}

std::optional<LineCoordinates> AnalyticSurface::lines(const Vec3& p) const {
  if (!lines_) return std::nullopt;
  return lines_(p);
}

AnalyticSurface analytic_surface(SampleKind kind) {
  switch (kind) {
    case SampleKind::plane:
      return plane();
    case SampleKind::sphere:
      return ellipsoid(Vec3::Constant(kSphereRadius));
    case SampleKind::cylinder:
    case SampleKind::open_cylinder:
      return cylinder(kCylinderRadius);
    case SampleKind::torus:
      return torus(kTorusMajorRadius, kTorusMinorRadius);
    case SampleKind::ellipsoid:
      return ellipsoid(Vec3(kEllipsoidAxes[0], kEllipsoidAxes[1], kEllipsoidAxes[2]));
    case SampleKind::hyperboloid:
      return hyperboloid(kHyperboloidWaist, kHyperboloidSlope);
    case SampleKind::saddle:
      return saddle(kSaddleBend);
    case SampleKind::part:
      break;
  }
  throw std::invalid_argument("the part has no one equation");
}

}  // namespace strake::support
