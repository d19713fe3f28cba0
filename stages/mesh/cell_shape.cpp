#include "stages/mesh/cell_shape.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace strake {
namespace {

constexpr double kRightAngle = M_PI / 2;
/// Faces thinner than this, as area over squared perimeter, are as good as degenerate.
constexpr double kThinnest = 1e-4;
constexpr double kReflexPenalty = 4;
constexpr double kNoQuadPenalty = 0.2;

}  // namespace

Polygon corner_positions(const PolygonGraph& graph, const std::vector<Index>& cell) {
  Polygon p;
  p.reserve(cell.size());
  for (const Index d : cell) p.push_back(graph.position(graph.graph().from(d)));
  return p;
}

Vec3 vector_area(const Polygon& p) {
  Vec3 n = Vec3::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) n += (p[i] - p[0]).cross(p[(i + 1) % p.size()] - p[0]);
  return 0.5 * n;
}

double interior_angle(const Polygon& p, std::size_t i, const Vec3& n) {
  const std::size_t size = p.size();
  const Vec3 a = p[(i + 1) % size] - p[i];
  const Vec3 b = p[(i + size - 1) % size] - p[i];
  const double angle = std::atan2(a.cross(b).dot(n), a.dot(b));
  return angle < 0 ? angle + 2 * M_PI : angle;
}

bool is_reflex(const Polygon& p, std::size_t i, const Vec3& n) {
  const std::size_t size = p.size();
  const Vec3 a = p[(i + 1) % size] - p[i];
  const Vec3 b = p[(i + size - 1) % size] - p[i];
  return a.cross(b).dot(n) < -1e-10 * a.norm() * b.norm();
}

double shape_penalty(const Polygon& p, const Vec3& surface_normal) {
  const Vec3 normal = vector_area(p);
  const double area = normal.norm();
  double around = 0;
  for (std::size_t i = 0; i < p.size(); ++i) around += (p[(i + 1) % p.size()] - p[i]).norm();
  if (!(area > kThinnest * around * around)) return std::numeric_limits<double>::infinity();
  if (normal.dot(surface_normal) <= 0) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double off = interior_angle(p, i, normal / area) - kRightAngle;
    sum += off * off;
    if (is_reflex(p, i, normal / area)) sum += kReflexPenalty;
  }
  return sum / static_cast<double>(p.size()) + (p.size() == 4 ? 0.0 : kNoQuadPenalty);
}

}  // namespace strake
