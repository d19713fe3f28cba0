#include "stages/evaluate/shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "common/geometry/face_crossings/face_crossings.h"
#include "stages/evaluate/statistics.h"

namespace strake::evaluation {
namespace {

constexpr double kDegenerate = 1e-6;
constexpr double kConcave = 1e-9;
constexpr double kTJointAngle = 160;
constexpr double kSmallAngle = 10;
constexpr double kFlatCorner = 175;
constexpr int kLargestValence = 8;

/// The form of one face.
struct FaceForm {
  std::vector<double> angles;   // of the corners, degrees
  double least_sine = 1;        // of the corners, along the normal
  std::vector<double> lengths;  // of the edges
};

FaceForm form_of(const PolyMesh& mesh, Index f) {
  const std::span<const Index> face = mesh.face(f);
  const std::size_t n = face.size();
  const Vec3 normal = newell_normal(mesh.positions, face).normalized();
  FaceForm form;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = mesh.positions[face[i]];
    const Vec3 ahead = mesh.positions[face[(i + 1) % n]] - p;
    const Vec3 back = mesh.positions[face[(i + n - 1) % n]] - p;
    const Vec3 turn = ahead.cross(back);
    const double along = turn.dot(normal);
    const double scale = ahead.norm() * back.norm();
    const double angle = std::atan2(turn.norm(), ahead.dot(back)) * 180 / std::numbers::pi;
    form.angles.push_back(along < -kConcave * scale ? 360 - angle : angle);
    form.least_sine = std::min(form.least_sine, share(along, scale));
    form.lengths.push_back(ahead.norm());
  }
  return form;
}

std::vector<double> face_areas(const PolyMesh& mesh, const FaceTriangles& triangles) {
  std::vector<double> area(static_cast<std::size_t>(mesh.face_count()), 0.0);
  for (std::size_t t = 0; t < triangles.face.size(); ++t) {
    const auto& [a, b, c] = triangles.corners[t];
    const Vec3& p = mesh.positions[a];
    area[triangles.face[t]] += (mesh.positions[b] - p).cross(mesh.positions[c] - p).norm() / 2;
  }
  return area;
}

double off_plane(const PolyMesh& mesh, Index f, double area) {
  const std::span<const Index> face = mesh.face(f);
  Vec3 middle = Vec3::Zero();
  for (const Index v : face) middle += mesh.positions[v];
  middle /= static_cast<double>(face.size());
  const Vec3 normal = newell_normal(mesh.positions, face).normalized();
  double most = 0;
  for (const Index v : face) {
    most = std::max(most, std::abs((mesh.positions[v] - middle).dot(normal)));
  }
  return most / std::sqrt(area);
}

/// Lists of figures over all faces that have an area.
struct Collection {
  Index degenerate = 0, concave = 0;
  Index flat_quads = 0;              // with a corner that is nearly straight
  std::vector<double> least_angles;  // of each face
  std::vector<double> angles, quad_deviation, aspect, stretch, jacobian, off_plane;

  void add(const PolyMesh& mesh, Index f, double area) {
    const FaceForm form = form_of(mesh, f);
    const double longest = largest(form.lengths);
    if (!(area > kDegenerate * longest * longest)) {
      ++degenerate;
      return;
    }
    if (is_concave_face(mesh.positions, mesh.face(f))) ++concave;
    angles.insert(angles.end(), form.angles.begin(), form.angles.end());
    least_angles.push_back(smallest(form.angles));
    const std::size_t n = form.angles.size();
    if (n <= 4) {
      const double round = n == 3 ? std::numbers::sqrt3 : 1.0;
      const double perimeter = mean(form.lengths) * static_cast<double>(n);
      aspect.push_back(longest * perimeter / (4 * round * area));
    }
    if (n > 3) off_plane.push_back(evaluation::off_plane(mesh, f, area));
    if (n != 4) return;
    if (largest(form.angles) >= kFlatCorner) ++flat_quads;
    for (const double angle : form.angles) quad_deviation.push_back(std::abs(angle - 90));
    const auto [shorter, longer] =
        std::minmax({form.lengths[0] + form.lengths[2], form.lengths[1] + form.lengths[3]});
    stretch.push_back(share(longer, shorter));
    jacobian.push_back(form.least_sine);
  }
};

double share_below(const std::vector<double>& values, double bound) {
  const auto below =
      std::count_if(values.begin(), values.end(), [bound](double v) { return v <= bound; });
  return share(static_cast<double>(below), static_cast<double>(values.size()));
}

void report_sides(const PolyTopology& topology, const PolyMesh& mesh,
                  const std::vector<double>& area, const Collection& all, Report& report) {
  double total = 0;
  double in_quads = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    total += area[f];
    if (mesh.face(f).size() == 4) in_quads += area[f];
  }
  report.set("faces.count", std::int64_t{topology.faces});
  report.set("faces.triangles", std::int64_t{topology.triangles});
  report.set("faces.quads", std::int64_t{topology.quads});
  report.set("faces.pentagons", std::int64_t{topology.pentagons});
  report.set("faces.larger", std::int64_t{topology.larger_faces});
  report.set("faces.most_sides", std::int64_t{topology.most_sides});
  report.set("faces.quad_share", share(topology.quads, topology.faces));
  report.set("faces.quad_area_share", share(in_quads, total));
  report.set("faces.area", total);
  report.set("faces.concave", std::int64_t{all.concave});
  report.set("faces.flat_quads", std::int64_t{all.flat_quads});
  report.set("faces.degenerate", std::int64_t{all.degenerate});
}

void report_angles(const Collection& all, Report& report) {
  report.set("angles.min_deg", smallest(all.angles));
  report.set("angles.face_share_above_10_deg",
             all.least_angles.empty() ? 0.0 : 1 - share_below(all.least_angles, kSmallAngle));
  report.set("angles.p01_deg", quantile(all.angles, 0.01));
  report.set("angles.p05_deg", quantile(all.angles, 0.05));
  report.set("angles.median_deg", quantile(all.angles, 0.5));
  report.set("angles.p95_deg", quantile(all.angles, 0.95));
  report.set("angles.p99_deg", quantile(all.angles, 0.99));
  report.set("angles.max_deg", largest(all.angles));
  report.set("angles.quad_deviation_mean_deg", mean(all.quad_deviation));
  report.set("angles.quad_deviation_rms_deg", rms(all.quad_deviation));
  report.set("angles.quad_within_15_deg_share", share_below(all.quad_deviation, 15));
  report.set("angles.quad_within_30_deg_share", share_below(all.quad_deviation, 30));
}

void report_proportions(const Collection& all, Report& report) {
  report.set("shape.aspect_mean", mean(all.aspect));
  report.set("shape.aspect_p95", quantile(all.aspect, 0.95));
  report.set("shape.aspect_max", largest(all.aspect));
  report.set("shape.stretch_median", quantile(all.stretch, 0.5));
  report.set("shape.stretch_p95", quantile(all.stretch, 0.95));
  report.set("shape.stretch_max", largest(all.stretch));
  report.set("shape.jacobian_mean", mean(all.jacobian));
  report.set("shape.jacobian_p05", quantile(all.jacobian, 0.05));
  report.set("shape.jacobian_min", smallest(all.jacobian));
  report.set("shape.off_plane_mean", mean(all.off_plane));
  report.set("shape.off_plane_p95", quantile(all.off_plane, 0.95));
  report.set("shape.off_plane_max", largest(all.off_plane));
}

}  // namespace

std::vector<std::array<Index, 2>> report_shape(const PolyMesh& mesh, const PolyTopology& topology,
                                               const FaceTriangles& triangles,
                                               const PolyEdges& edges, Report& report) {
  const std::vector<double> area = face_areas(mesh, triangles);
  Collection all;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(f).size() >= 3) all.add(mesh, f, area[f]);
  }
  std::vector<double> lengths;
  for (const auto& [a, b] : edges.vertices) {
    lengths.push_back((mesh.positions[b] - mesh.positions[a]).norm());
  }
  report_sides(topology, mesh, area, all, report);
  report_angles(all, report);
  report_proportions(all, report);
  std::vector<std::array<Index, 2>> crossing = find_crossing_faces(mesh.positions, triangles);
  report.set("shape.self_intersecting_pairs", crossing.size());
  report.set("edges.count", std::int64_t{topology.edges});
  report.set("edges.length_min", smallest(lengths));
  report.set("edges.length_mean", mean(lengths));
  report.set("edges.length_max", largest(lengths));
  return crossing;
}

void report_valence(const PolyMesh& mesh, const PolyEdges& edges, Report& report) {
  std::vector<Index> valence(mesh.positions.size(), 0);
  std::vector<std::uint8_t> is_inside(mesh.positions.size(), 1);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    for (const Index v : edges.vertices[e]) {
      ++valence[v];
      if (edges.sides_of(e).size() != 2) is_inside[v] = 0;
    }
  }
  std::vector<std::uint8_t> has_flat_corner(mesh.positions.size(), 0);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(f).size() < 3) continue;
    const std::vector<double> angles = form_of(mesh, f).angles;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      if (angles[i] > kTJointAngle) has_flat_corner[mesh.face(f)[i]] = 1;
    }
  }
  std::array<Index, kLargestValence + 1> histogram = {};
  Index inside = 0;
  Index t_joints = 0;
  for (std::size_t v = 0; v < valence.size(); ++v) {
    if (is_inside[v] == 0 || valence[v] == 0) continue;
    ++inside;
    ++histogram[std::min(valence[v], kLargestValence)];
    if (valence[v] == 3 && has_flat_corner[v] != 0) ++t_joints;
  }
  report.set("valence.interior_vertices", std::int64_t{inside});
  report.set("valence.t_joints", std::int64_t{t_joints});
  for (int k = 2; k < kLargestValence; ++k) {
    report.set("valence.share_" + std::to_string(k), share(histogram[k], inside));
  }
  report.set("valence.share_" + std::to_string(kLargestValence) + "_or_more",
             share(histogram.back(), inside));
}

}  // namespace strake::evaluation
