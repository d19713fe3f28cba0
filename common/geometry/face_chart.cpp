#include "common/geometry/face_chart.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"

namespace strake {
namespace {

/// The third corner of a face whose other two corners lie at `a` and `b`, left of a -> b.
Vec2 third_corner(const Vec3& pa, const Vec3& pb, const Vec3& pc, const Vec2& a, const Vec2& b) {
  const Vec3 edge = pb - pa;
  const Vec3 side = pc - pa;
  const double length2 = edge.squaredNorm();
  const Vec2 along = b - a;
  if (!(length2 > 0)) return a + Vec2(side.norm(), 0);
  const double s = side.dot(edge) / length2;
  const double height = edge.cross(side).norm() / length2;
  return a + s * along + height * Vec2(-along.y(), along.x());
}

}  // namespace

Vec3 FaceChart::barycentric(const Vec2& point) const {
  const double area = cross2(corner[1] - corner[0], corner[2] - corner[0]);
  if (!(area > 0)) return Vec3::Constant(1.0 / 3);
  const double b0 = cross2(corner[1] - point, corner[2] - point) / area;
  const double b1 = cross2(corner[2] - point, corner[0] - point) / area;
  return {b0, b1, 1.0 - b0 - b1};
}

FaceChart lay_out(const TriMesh& mesh, Index face) {
  const auto& f = mesh.faces[face];
  FaceChart chart;
  chart.face = face;
  chart.corner[0] = Vec2::Zero();
  chart.corner[1] = Vec2((mesh.positions[f[1]] - mesh.positions[f[0]]).norm(), 0);
  chart.corner[2] = third_corner(mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]],
                                 chart.corner[0], chart.corner[1]);
  return chart;
}

ChartAxes chart_axes(const TriMesh& mesh, Index face, const Vec3& normal) {
  const auto& f = mesh.faces[face];
  const Vec3 edge = mesh.positions[f[1]] - mesh.positions[f[0]];
  const Vec3 flat = edge - normal * normal.dot(edge);
  const double length = flat.norm();
  if (!(length > 0)) {
    const TangentFrame frame = tangent_frame(normal);
    return {frame.x, frame.y};
  }
  const Vec3 x = flat / length;
  return {x, normal.cross(x)};
}

FaceChart unfold(const TriMesh& mesh, const FaceChart& chart, Index h) {
  const Index t = mesh.twin[h];
  const int i = h % 3;
  const int j = t % 3;
  FaceChart next;
  next.face = TriMesh::face_of(t);
  // The twin runs the other way: its origin is the end of h.
  next.corner[j] = chart.corner[(i + 1) % 3];
  next.corner[(j + 1) % 3] = chart.corner[i];
  const auto& f = mesh.faces[next.face];
  next.corner[(j + 2) % 3] =
      third_corner(mesh.positions[f[j]], mesh.positions[f[(j + 1) % 3]],
                   mesh.positions[f[(j + 2) % 3]], next.corner[j], next.corner[(j + 1) % 3]);
  return next;
}

std::optional<FaceExit> find_exit(const FaceChart& chart, const Vec2& point,
                                  const Vec2& displacement, const std::array<Index, 2>& closed) {
  FaceExit best;
  best.step = 1;
  for (int i = 0; i < 3; ++i) {
    const Index h = 3 * chart.face + i;
    if (h == closed[0] || h == closed[1]) continue;
    const Vec2& a = chart.corner[i];
    const Vec2 edge = chart.corner[(i + 1) % 3] - a;
    const double speed = -cross2(edge, displacement);  // towards the outside
    if (!(speed > 0)) continue;
    const double step = std::max(0.0, cross2(edge, point - a) / speed);
    if (step >= best.step) continue;
    const double length2 = edge.squaredNorm();
    best.halfedge = h;
    best.step = step;
    best.lambda = length2 > 0
                      ? std::clamp((point + step * displacement - a).dot(edge) / length2, 0.0, 1.0)
                      : 0.5;
  }
  if (best.halfedge == kNone) return std::nullopt;
  return best;
}

std::optional<VertexExit> cross_vertex(const TriMesh& mesh, Index corner, double angle) {
  double total = 0;
  Index first = corner;
  bool open = false;
  for (Index h = corner;;) {  // to the clockwise end of the fan, or once around
    const Index before = mesh.rotate_cw(h);
    if (before == kNone) open = true;
    if (before == kNone || before == corner) break;
    h = before;
    first = h;
  }
  if (!open) first = corner;
  double position = angle;  // of the way back, from `first`
  bool seen = false;
  for (Index h = first; h != kNone;) {
    if (h == corner) seen = true;
    const double here = corner_angle(mesh, h);
    if (!seen) position += here;
    total += here;
    h = mesh.rotate_ccw(h);
    if (h == first) break;
  }
  // A straight line has equal angles on both sides.
  double wanted = open ? position + M_PI : position + total / 2;
  if (!open && wanted >= total) wanted -= total;
  if (open && wanted >= total) wanted = position - M_PI;
  if (wanted < 0 || !(total > 0)) return std::nullopt;
  for (Index h = first; h != kNone;) {
    const double here = corner_angle(mesh, h);
    if (wanted <= here) return VertexExit{h, wanted};
    wanted -= here;
    h = mesh.rotate_ccw(h);
    if (h == first) break;
  }
  return std::nullopt;
}

}  // namespace strake
