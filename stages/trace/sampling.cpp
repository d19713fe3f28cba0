#include "stages/trace/sampling.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/frames.h"

namespace strake {
namespace {

/// Faces whose principal directions differ by more than this are crossed on a trusted direction
/// ([MK04] section 4.2).
const double kLeastConfidence = std::cos(M_PI / 6);

/// Barycentric weights kept inside the face: points may lie outside by rounding.
Vec3 weights(const FaceChart& chart, const Vec2& point) {
  Vec3 b = chart.barycentric(point).cwiseMax(0.0);
  const double sum = b.sum();
  return sum > 0 ? Vec3(b / sum) : Vec3::Constant(1.0 / 3);
}

/// Rotation of a chart against `lay_out`, where corner 0 to corner 1 is the positive x axis.
std::complex<double> chart_turn(const FaceChart& chart) {
  const Vec2 base = chart.corner[1] - chart.corner[0];
  const double length = base.norm();
  return length > 0 ? std::complex<double>(base.x(), base.y()) / length
                    : std::complex<double>(1, 0);
}

/// Fills directions from world space; `turn` is the chart's rotation against `lay_out`.
void set_directions(const TraceDomain& domain, const std::complex<double>& turn,
                    FieldContext& context) {
  const Index face = context.chart.face;
  const Vec3 normal = domain.face_normals[face];
  const ChartAxes axes = domain.axes(face);
  const PrincipalField& field = domain.field;
  for (int i = 0; i < 3; ++i) {
    const Index w = domain.mesh.face_wedges[face][i];
    const Vec3 d = rotate_between(field.normal[w], normal, field.cross[w]);
    std::complex<double> z(axes.x.dot(d), axes.y.dot(d));
    const double length = std::abs(z);
    z = (length > 0 ? z / length : std::complex<double>(1, 0)) * turn;
    context.arm[i] = Vec2(z.real(), z.imag());
    const std::complex<double> square = z * z;
    // Without the extension the tensors' deviators are interpolated, as [MK04] section 2 does.
    context.power[i] =
        field.cross_extended ? square * square : square * std::abs(field.k_max[w] - field.k_min[w]);
  }
  if (field.cross_extended) {
    const auto agree = [&](int i, int j) {
      return (context.power[i] * std::conj(context.power[j])).real() > -0.2;
    };
    context.reliable = agree(0, 1) && agree(1, 2) && agree(2, 0);
  } else {
    context.reliable = field.face_confidence[face] >= kLeastConfidence;
  }
}

std::complex<double> interpolated_power(const FieldContext& context, const Vec2& point) {
  const Vec3 b = weights(context.chart, point);
  return context.power[0] * b[0] + context.power[1] * b[1] + context.power[2] * b[2];
}

}  // namespace

FieldContext field_context(const TraceDomain& domain, Index face) {
  FieldContext context;
  context.chart = lay_out(domain.mesh, face);
  set_directions(domain, {1, 0}, context);
  return context;
}

FieldContext unfold_context(const TraceDomain& domain, const FieldContext& context, Index h) {
  FieldContext next;
  next.chart = unfold(domain.mesh, context.chart, h);
  set_directions(domain, chart_turn(next.chart), next);
  return next;
}

Vec2 field_direction(const TraceDomain& domain, const FieldContext& context, const Vec2& point,
                     const Vec2& heading, LineFamily family) {
  if (!context.reliable) return heading;
  const std::complex<double> power = interpolated_power(context, point);
  if (!(std::abs(power) > 0)) return heading;
  if (domain.field.cross_extended) return cross_arm(power, heading);
  const double angle = std::arg(power) / 2 + (family == LineFamily::maximum ? M_PI / 2 : 0.0);
  const Vec2 d(std::cos(angle), std::sin(angle));
  return d.dot(heading) >= 0 ? d : Vec2(-d);
}

LineFamily family_at(const TraceDomain& domain, const FieldContext& context, const Vec2& point,
                     const Vec2& heading) {
  double along = 0;
  if (domain.field.cross_extended) {
    const Vec3 b = weights(context.chart, point);
    for (int i = 0; i < 3; ++i) {
      const double c = context.arm[i].dot(heading);
      along += b[i] * (2 * c * c - 1);
    }
  } else {
    const std::complex<double> power = interpolated_power(context, point);
    const std::complex<double> h(heading.x(), heading.y());
    along = (power * std::conj(h * h)).real();
  }
  return along >= 0 ? LineFamily::minimum : LineFamily::maximum;
}

LocalSpacing spacing_at(const TraceDomain& domain, const FieldContext& context, const Vec2& point,
                        const Vec2& heading) {
  const Vec3 b = weights(context.chart, point);
  LocalSpacing local;
  for (int i = 0; i < 3; ++i) {
    const Index w = domain.mesh.face_wedges[context.chart.face][i];
    const double c = context.arm[i].dot(heading);
    const bool follows_arm = c * c >= 0.5 * heading.squaredNorm();
    const double along = domain.spacing.along[w];
    const double across = domain.spacing.across[w];
    local.to_neighbours += b[i] * (follows_arm ? across : along);
    local.along += b[i] * (follows_arm ? along : across);
  }
  return local;
}

Vec3 world_point(const TraceDomain& domain, const FieldContext& context, const Vec2& point) {
  const Vec3 b = weights(context.chart, point);
  const auto& f = domain.mesh.faces[context.chart.face];
  return domain.mesh.positions[f[0]] * b[0] + domain.mesh.positions[f[1]] * b[1] +
         domain.mesh.positions[f[2]] * b[2];
}

Vec3 world_direction(const TraceDomain& domain, const FieldContext& context,
                     const Vec2& direction) {
  const ChartAxes axes = domain.axes(context.chart.face);
  const std::complex<double> local =
      std::complex<double>(direction.x(), direction.y()) * std::conj(chart_turn(context.chart));
  return axes.x * local.real() + axes.y * local.imag();
}

Vec2 chart_direction(const TraceDomain& domain, const FieldContext& context,
                     const Vec3& direction) {
  const ChartAxes axes = domain.axes(context.chart.face);
  const std::complex<double> z =
      std::complex<double>(axes.x.dot(direction), axes.y.dot(direction)) *
      chart_turn(context.chart);
  return {z.real(), z.imag()};
}

}  // namespace strake
