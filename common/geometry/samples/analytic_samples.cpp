#include <cmath>
#include <numbers>

#include "common/geometry/samples/sample_designs.h"

namespace strake {
namespace {

/// A square |x|, |y| <= half on a graph surface, as four curves.
void design_square(const SurfacePtr& surface, double half, double size, SurfaceBuilder& builder) {
  const std::array<Vec2, 4> corners = {Vec2(half, half), Vec2(-half, half), Vec2(-half, -half),
                                       Vec2(half, -half)};
  std::array<Index, 4> vertices{};
  for (std::size_t i = 0; i < 4; ++i) vertices[i] = builder.add_corner(surface->lift(corners[i]));
  std::vector<Index> curves;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 from = corners[i], to = corners[(i + 1) % 4];
    curves.push_back(builder.add_curve(
        vertices[i], vertices[(i + 1) % 4],
        [=](double t) { return surface->lift(from + t * (to - from)); }, size));
  }
  builder.add_patch(surface, size, curves, 0);
}

/// Two halves above and below a seam around the equator.
void design_ellipsoid(const Vec3& axes, double size, SurfaceBuilder& builder) {
  const Frame up;
  const Frame down = Frame::along(Vec3::Zero(), -Vec3::UnitZ(), Vec3::UnitX());
  const SurfacePtr upper = ellipsoid_surface(up, axes), lower = ellipsoid_surface(down, axes);
  const auto equator = [=](double t) {
    return circle_curve(up, 1, 0)(t).cwiseProduct(axes).eval();
  };
  const Index seam = builder.add_seam(equator, size, upper);
  builder.add_patch(upper, size, {seam}, 0);
  builder.add_patch(lower, size, {seam}, 0);
}

void design_cylinder(double size, bool caps, SurfaceBuilder& builder) {
  const SurfacePtr side = cylinder_surface(Frame(), kCylinderRadius, Side::away);
  std::array<Index, 2> rims{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double z = i == 0 ? -kCylinderHalfHeight : kCylinderHalfHeight;
    rims[i] = builder.add_loop(circle_curve(Frame(), kCylinderRadius, z), size);
  }
  builder.add_patch(side, size, {rims[0], rims[1]}, 0);
  if (!caps) return;
  for (std::size_t i = 0; i < 2; ++i) {
    const double sign = i == 0 ? -1 : 1;
    const Frame frame =
        Frame::along(Vec3(0, 0, sign * kCylinderHalfHeight), sign * Vec3::UnitZ(), Vec3::UnitX());
    builder.add_patch(plane_surface(frame), size, {rims[i]}, static_cast<Index>(i) + 1);
  }
}

void design_torus(double size, SurfaceBuilder& builder) {
  const auto half = [](bool inner) {
    return torus_surface(Frame(), kTorusMajorRadius, kTorusMinorRadius, inner, Side::away);
  };
  const SurfacePtr outer = half(false), inner = half(true);
  std::vector<Index> seams;
  for (const double z : {-kTorusMinorRadius, kTorusMinorRadius}) {
    seams.push_back(builder.add_seam(circle_curve(Frame(), kTorusMajorRadius, z), size, outer));
  }
  builder.add_patch(outer, size, seams, 0);
  builder.add_patch(inner, size, seams, 0);
}

void design_hyperboloid(double size, SurfaceBuilder& builder) {
  const SurfacePtr surface = hyperboloid_surface(kHyperboloidWaist, kHyperboloidSlope);
  const double radius =
      kHyperboloidWaist * std::hypot(1.0, kHyperboloidHalfHeight / kHyperboloidSlope);
  std::vector<Index> rims;
  for (const double z : {-kHyperboloidHalfHeight, kHyperboloidHalfHeight}) {
    rims.push_back(builder.add_loop(circle_curve(Frame(), radius, z), size));
  }
  builder.add_patch(surface, size, rims, 0);
}

}  // namespace

SurfaceBuilder::CurveFunction circle_curve(const Frame& frame, double radius, double height) {
  return [=](double t) {
    const double angle = 2 * std::numbers::pi * t;
    return frame.to_world({radius * std::cos(angle), radius * std::sin(angle), height});
  };
}

void design_analytic(SampleKind kind, double size, SurfaceBuilder& builder) {
  switch (kind) {
    case SampleKind::plane:
      return design_square(plane_surface(Frame()), kPlaneHalfSize, size, builder);
    case SampleKind::sphere:
      return design_ellipsoid(Vec3::Constant(kSphereRadius), size, builder);
    case SampleKind::cylinder:
      return design_cylinder(size, true, builder);
    case SampleKind::open_cylinder:
      return design_cylinder(size, false, builder);
    case SampleKind::torus:
      return design_torus(size, builder);
    case SampleKind::ellipsoid:
      return design_ellipsoid(Vec3(kEllipsoidAxes[0], kEllipsoidAxes[1], kEllipsoidAxes[2]), size,
                              builder);
    case SampleKind::hyperboloid:
      return design_hyperboloid(size, builder);
    case SampleKind::saddle:
      return design_square(saddle_surface(kSaddleBend), kSaddleHalfSize, size, builder);
    case SampleKind::part:
      return design_part(size, builder);
  }
}

}  // namespace strake
