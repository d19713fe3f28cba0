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

/// A corner of a polygon, seen along a unit normal.
class Corner {
 public:
  Corner(const Polygon& p, std::size_t i, const Vec3& n)
      : next_(p[i + 1 < p.size() ? i + 1 : 0] - p[i]),
        previous_(p[i > 0 ? i - 1 : p.size() - 1] - p[i]),
        turn_(next_.cross(previous_).dot(n)) {}

  /// In [0, 2 pi).
  [[nodiscard]] double angle() const {
    const double angle = std::atan2(turn_, next_.dot(previous_));
    return angle < 0 ? angle + 2 * M_PI : angle;
  }
  [[nodiscard]] bool is_reflex() const {
    return turn_ < 0 && turn_ < -1e-10 * next_.norm() * previous_.norm();
  }

 private:
  Vec3 next_;
  Vec3 previous_;
  double turn_;
};

}  // namespace

Polygon corner_positions(const PolygonGraph& graph, const DartLoop& cell) {
  Polygon p;
  p.reserve(cell.size());
  for (const Index d : cell) p.push_back(graph.position(graph.graph().from(d)));
  return p;
}

Vec3 vector_area(const Polygon& p) {
  Vec3 n = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < p.size(); ++i) n += (p[i] - p[0]).cross(p[i + 1] - p[0]);
  return 0.5 * n;
}

double interior_angle(const Polygon& p, std::size_t i, const Vec3& n) {
  return Corner(p, i, n).angle();
}

bool is_reflex(const Polygon& p, std::size_t i, const Vec3& n) {
  return Corner(p, i, n).is_reflex();
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
    const Corner corner(p, i, normal / area);
    const double off = corner.angle() - kRightAngle;
    sum += off * off;
    if (corner.is_reflex()) sum += kReflexPenalty;
  }
  return sum / static_cast<double>(p.size()) + (p.size() == 4 ? 0.0 : kNoQuadPenalty);
}

}  // namespace strake
