#include "stages/tensor/ball.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/frames.h"

namespace strake {
namespace {

double squared_distance_to_segment(const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp(-a.dot(d) / length, 0.0, 1.0) : 0.0;
  return (a + t * d).squaredNorm();
}

/// Signed area between the origin, a and b inside the disk of radius r around the origin.
double disk_sector_area(const Vec2& a, const Vec2& b, double r) {
  const auto wedge = [r](const Vec2& p, const Vec2& q) {
    return 0.5 * r * r * std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
  };
  const auto triangle = [](const Vec2& p, const Vec2& q) {
    return 0.5 * (p.x() * q.y() - p.y() * q.x());
  };
  const Vec2 d = b - a;
  const double qa = d.squaredNorm();
  if (!(qa > 0)) return 0;
  const double qb = a.dot(d);
  const double discriminant = qb * qb - qa * (a.squaredNorm() - r * r);
  if (discriminant <= 0) return wedge(a, b);
  const double root = std::sqrt(discriminant);
  const double t0 = (-qb - root) / qa;
  const double t1 = (-qb + root) / qa;
  if (t1 <= 0 || t0 >= 1) return wedge(a, b);
  const Vec2 p = t0 > 0 ? Vec2(a + t0 * d) : a;
  const Vec2 q = t1 < 1 ? Vec2(a + t1 * d) : b;
  return (t0 > 0 ? wedge(a, p) : 0.0) + triangle(p, q) + (t1 < 1 ? wedge(q, b) : 0.0);
}

}  // namespace

double clipped_length(const Vec3& a, const Vec3& b, double r) {
  const Vec3 d = b - a;
  const double length = d.norm();
  if (!(length > 0)) return 0;
  const double middle = -a.dot(d) / length;  // foot of the centre, measured from a
  const double half_squared = r * r - (a + d * (middle / length)).squaredNorm();
  if (half_squared <= 0) return 0;
  const double half = std::sqrt(half_squared);
  return std::max(0.0, std::min(length, middle + half) - std::max(0.0, middle - half));
}

double clipped_area(const Vec3& a, const Vec3& b, const Vec3& c, double r) {
  const Vec3 normal = (b - a).cross(c - a);
  const double twice = normal.norm();
  if (!(twice > 0)) return 0;
  const double r2 = r * r;
  if (a.squaredNorm() <= r2 && b.squaredNorm() <= r2 && c.squaredNorm() <= r2) return 0.5 * twice;
  const Vec3 n = normal / twice;
  const double height = a.dot(n);
  const double disk2 = r2 - height * height;
  if (disk2 <= 0) return 0;
  const TangentFrame frame = tangent_frame(n);
  const Vec2 pa = frame.tangent_from_world(a);
  const Vec2 pb = frame.tangent_from_world(b);
  const Vec2 pc = frame.tangent_from_world(c);
  const double disk = std::sqrt(disk2);
  return std::max(0.0, disk_sector_area(pa, pb, disk) + disk_sector_area(pb, pc, disk) +
                           disk_sector_area(pc, pa, disk));
}

BallWalker::BallWalker(const TriMesh& mesh, const std::vector<Vec3>& normals,
                       const std::vector<float>& bend)
    : mesh_(mesh), normals_(normals), bend_(bend), stamp_(mesh.face_count(), 0) {}

void BallWalker::visit(Index face) {
  if (is_visited(face)) return;
  stamp_[face] = current_;
  front_.push_back(face);
}

std::array<double, 6> BallWalker::tensor(Index h, const Vec3& normal, double radius) {
  if (++current_ == 0) {
    std::fill(stamp_.begin(), stamp_.end(), 0U);
    current_ = 1;
  }
  front_.clear();
  visit(TriMesh::face_of(h));

  const Vec3 centre = mesh_.positions[mesh_.from(h)];
  const double r2 = radius * radius;
  double area = 0;
  std::array<double, 6> sum{};
  for (std::size_t at = 0; at < front_.size(); ++at) {
    const Index f = front_[at];
    const auto& v = mesh_.faces[f];
    const std::array<Vec3, 3> p = {mesh_.positions[v[0]] - centre, mesh_.positions[v[1]] - centre,
                                   mesh_.positions[v[2]] - centre};
    const std::array<bool, 3> inside = {p[0].squaredNorm() <= r2, p[1].squaredNorm() <= r2,
                                        p[2].squaredNorm() <= r2};
    // Most faces lie inside as a whole; nothing of them needs to be clipped.
    area += inside[0] && inside[1] && inside[2] ? 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm()
                                                : clipped_area(p[0], p[1], p[2], radius);
    for (int i = 0; i < 3; ++i) {
      const Index e = 3 * f + i;
      if (mesh_.is_barrier(e)) continue;
      const int j = (i + 1) % 3;
      const bool whole = inside[i] && inside[j];
      if (!inside[i] && !inside[j] && squared_distance_to_segment(p[i], p[j]) >= r2) continue;
      const Index twin = mesh_.twin[e];
      const Index other = TriMesh::face_of(twin);
      if (normals_[other].dot(normal) <= 0) continue;  // folds over to another sheet
      visit(other);
      if (e > twin) continue;  // each edge once: both its faces are visited
      const Vec3 d = p[j] - p[i];
      double weight = bend_[e];
      if (!whole) weight *= clipped_length(p[i], p[j], radius) / d.norm();
      sum[0] += weight * d.x() * d.x();
      sum[1] += weight * d.x() * d.y();
      sum[2] += weight * d.x() * d.z();
      sum[3] += weight * d.y() * d.y();
      sum[4] += weight * d.y() * d.z();
      sum[5] += weight * d.z() * d.z();
    }
  }
  if (area > 0) {
    for (double& entry : sum) entry /= area;
  }
  return sum;
}

}  // namespace strake
