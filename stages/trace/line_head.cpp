#include "stages/trace/line_head.h"

#include "common/geometry/line_chord.h"

namespace strake {
namespace {

constexpr int kMaxWalkFaces = 1000;  ///< hard bound on one straight walk

}  // namespace

LineHead start_head(const TraceDomain& domain, const Seed& seed, bool forward) {
  const TriMesh& mesh = domain.mesh;
  LineHead head;
  Index face = seed.face;
  Vec3 barycentric = seed.barycentric;
  if (seed.is_anchored() && !is_vertex_point(seed.anchor)) {
    Index h = seed.anchor.halfedge;
    double lambda = seed.anchor.lambda;
    if (!forward) {
      h = mesh.twin[h];
      lambda = 1 - lambda;
    }
    face = TriMesh::face_of(h);
    barycentric = Vec3::Zero();
    barycentric[h % 3] = 1 - lambda;
    barycentric[(h % 3 + 1) % 3] = lambda;
    head.closed = {h, kNone};
  } else if (seed.is_anchored()) {
    const Index h = seed.anchor.halfedge;
    face = TriMesh::face_of(h);
    barycentric = Vec3::Unit(h % 3);
    head.closed = {h, TriMesh::prev(h)};
    head.from_corner = true;
  }
  head.context = field_context(domain, face);
  head.point = head.context.chart.point(barycentric);
  Vec2 wanted = chart_direction(domain, head.context, seed.direction);
  if (!forward) wanted = -wanted;
  if (!(wanted.norm() > 0)) wanted = Vec2(1, 0);
  wanted.normalize();
  head.family = family_at(domain, head.context, head.point, wanted);
  // From a vertex the way into this face is given; turning it could point into another one.
  head.heading = head.from_corner
                     ? wanted
                     : field_direction(domain, head.context, head.point, wanted, head.family);
  head.trusted = head.heading;
  head.sign = forward ? 1 : -1;
  head.last = seed.anchor;
  head.last_position = world_point(domain, head.context, head.point);
  return head;
}

void walk_straight(const TraceDomain& domain, const Vec2& displacement, std::array<Index, 2> closed,
                   FieldContext& context, Vec2& point) {
  Vec2 rest = displacement;
  for (int guard = 0; guard < kMaxWalkFaces; ++guard) {
    const auto exit = find_exit(context.chart, point, rest, closed);
    if (!exit) {
      point += rest;
      return;
    }
    point += exit->step * rest;
    if (domain.mesh.is_barrier(exit->halfedge)) return;
    rest *= 1 - exit->step;
    context = unfold_context(domain, context, exit->halfedge);
    closed = {domain.mesh.twin[exit->halfedge], kNone};
  }
}

Vec2 runge_kutta(const TraceDomain& domain, const LineHead& head, double step) {
  const auto direction_after = [&](const Vec2& displacement) {
    FieldContext context = head.context;  // the saved context; predictions work on a copy
    Vec2 point = head.point;
    walk_straight(domain, displacement, head.closed, context, point);
    return field_direction(domain, context, point, displacement.normalized(), head.family);
  };
  const Vec2 k1 = field_direction(domain, head.context, head.point, head.heading, head.family);
  const Vec2 k2 = direction_after(k1 * (step / 2));
  const Vec2 k3 = direction_after(k2 * (step / 2));
  const Vec2 k4 = direction_after(k3 * step);
  const Vec2 sum = k1 + 2 * k2 + 2 * k3 + k4;
  const double length = sum.norm();
  return length > 0 ? Vec2(sum / length) : k1;
}

}  // namespace strake
