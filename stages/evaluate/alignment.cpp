#include "stages/evaluate/alignment.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/frames.h"
#include "stages/evaluate/statistics.h"

namespace strake::evaluation {
namespace {

constexpr double kAnisotropy = 0.5;
constexpr double kBend = 2;  // least |k_max| x diagonal
const double kConfident = std::cos(std::numbers::pi / 6);
constexpr double kLeastTangential = 0.34;  // cos 70 degrees
constexpr double kAlignedDeg = 10;

/// The field at a point of the reference.
struct FieldHere {
  TangentFrame frame;  // of the face
  Vec2 t_min;          // unit, in the frame; zero where the corners' directions cancel
  Vec2 cross;          // likewise
  bool is_anisotropic = false;
};

Vec2 direction_from_power(std::complex<double> power, int fold) {
  if (!(std::abs(power) > 1e-12)) return Vec2::Zero();
  const double angle = std::arg(power) / fold;
  return {std::cos(angle), std::sin(angle)};
}

FieldHere field_at(const TriMesh& mesh, const PrincipalField& field, Index face, const Vec3& normal,
                   const std::array<double, 3>& barycentric) {
  FieldHere here;
  here.frame = tangent_frame(normal);
  std::complex<double> t_min_power = 0;
  std::complex<double> cross_sum = 0;
  double k_min = 0;
  double k_max = 0;
  for (int i = 0; i < 3; ++i) {
    const Index w = mesh.face_wedges[face][i];
    const auto flatten = [&](const Vec3& v) {
      return here.frame.tangent_from_world(rotate_between(field.normal[w], normal, v));
    };
    const Vec2 t = flatten(field.t_min[w]);
    const std::complex<double> z(t.x(), t.y());
    t_min_power += barycentric[i] * z * z;
    cross_sum += barycentric[i] * cross_power(flatten(field.cross[w]));
    k_min += barycentric[i] * field.k_min[w];
    k_max += barycentric[i] * field.k_max[w];
  }
  here.t_min = direction_from_power(t_min_power, 2);
  here.cross = direction_from_power(cross_sum, 4);
  here.is_anisotropic =
      std::abs(k_max - k_min) > kAnisotropy * (std::abs(k_max) + std::abs(k_min)) &&
      std::abs(k_max) * mesh.diagonal > kBend && field.face_confidence[face] >= kConfident;
  return here;
}

/// Angle between a direction and the nearest arm of a cross, degrees in [0, 45].
double folded_angle(const Vec2& direction, const Vec2& arm) {
  const double along = std::abs(direction.dot(arm));
  const double across = std::abs(direction.x() * arm.y() - direction.y() * arm.x());
  return std::atan2(std::min(along, across), std::max(along, across)) * 180 / std::numbers::pi;
}

/// Length-weighted angles.
class AngleList {
 public:
  void add(double angle_deg, double weight) {
    total_ += weight;
    if (angle_deg < 0) return;
    angles_.push_back(angle_deg);
    weights_.push_back(weight);
  }

  void report_to(Report& report, const std::string& prefix) const {
    double judged = 0;
    double sum = 0;
    double aligned = 0;
    for (std::size_t i = 0; i < angles_.size(); ++i) {
      judged += weights_[i];
      sum += weights_[i] * angles_[i];
      if (angles_[i] < kAlignedDeg) aligned += weights_[i];
    }
    report.set(prefix + "judged_share", share(judged, total_));
    if (!(judged > 0)) return;  // no figure rather than a wrong one
    report.set(prefix + "within_10_deg_share", aligned / judged);
    report.set(prefix + "mean_deg", sum / judged);
    report.set(prefix + "median_deg", median(judged / 2));
  }

 private:
  [[nodiscard]] double median(double half) const {
    std::vector<std::size_t> order(angles_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return angles_[a] != angles_[b] ? angles_[a] < angles_[b] : a < b;
    });
    double run = 0;
    for (const std::size_t i : order) {
      run += weights_[i];
      if (run >= half) return angles_[i];
    }
    return angles_[order.back()];
  }

  std::vector<double> angles_, weights_;
  double total_ = 0;
};

void require_fit(const TriMesh& mesh, const PrincipalField& field) {
  const auto wedges = static_cast<std::size_t>(mesh.wedge_count());
  const bool fits = field.normal.size() == wedges && field.t_min.size() == wedges &&
                    field.k_min.size() == wedges && field.k_max.size() == wedges &&
                    field.cross.size() == wedges &&
                    field.face_confidence.size() == mesh.faces.size();
  if (!fits) {
    throw PreconditionError(
        "the field does not fit the reference: " + std::to_string(field.t_min.size()) +
        " directions for " + std::to_string(wedges) + " wedges; use the field of this very mesh");
  }
}

}  // namespace

std::vector<EdgeAngles> measure_edge_angles(const TriMesh& reference,
                                            const MeasuredSurface& reference_surface,
                                            const PrincipalField& field, const PolyMesh& candidate,
                                            const PolyEdges& edges) {
  require_fit(reference, field);
  std::vector<EdgeAngles> measured(edges.vertices.size());
  tbb::parallel_for(std::size_t{0}, measured.size(), [&](std::size_t e) {
    const Vec3& a = candidate.positions[edges.vertices[e][0]];
    const Vec3& b = candidate.positions[edges.vertices[e][1]];
    EdgeAngles& angles = measured[e];
    angles.length = (b - a).norm();
    const ClosestPoint foot = reference_surface.distance().closest((a + b) / 2);
    const FieldHere here = field_at(reference, field, reference_surface.source(foot.triangle),
                                    reference_surface.normal(foot.triangle), foot.barycentric);
    const Vec2 direction = here.frame.tangent_from_world(b - a);
    if (!(direction.norm() > kLeastTangential * angles.length)) return;
    const Vec2 unit = direction.normalized();
    if (here.is_anisotropic && !here.t_min.isZero(0)) {
      angles.principal_deg = folded_angle(unit, here.t_min);
    }
    if (!here.cross.isZero(0)) angles.cross_deg = folded_angle(unit, here.cross);
  });
  return measured;
}

void report_alignment(const TriMesh& reference, const MeasuredSurface& reference_surface,
                      const PrincipalField& field, const PolyMesh& candidate,
                      const PolyEdges& edges, Report& report) {
  const std::vector<EdgeAngles> measured =
      measure_edge_angles(reference, reference_surface, field, candidate, edges);
  AngleList all;
  AngleList quads;
  AngleList cross;
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const EdgeAngles& angles = measured[e];
    all.add(angles.principal_deg, angles.length);
    cross.add(angles.cross_deg, angles.length);
    const std::span<const Index> sides = edges.sides_of(e);
    if (std::any_of(sides.begin(), sides.end(), [&](Index side) {
          return candidate.face(edges.corner_face[side]).size() == 4;
        })) {
      quads.add(angles.principal_deg, angles.length);
    }
  }
  all.report_to(report, "alignment.");
  quads.report_to(report, "alignment.quads.");
  cross.report_to(report, "alignment.cross.");
}

}  // namespace strake::evaluation
