#include "stages/trace/half_line.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/angles.h"
#include "common/geometry/frames.h"
#include "common/geometry/line_chord.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// Edges that one step may cross: around a needle it would go on for ever.
constexpr int kMostCrossings = 4096;
const double kFlattestCrossing = std::sin(20 * kDegree);  ///< with a feature line

}  // namespace

void LineWalker::record(LineHead& head, const Chord& chord, HalfLine& half) {
  half.points.push_back(chord.to);
  half.faces.push_back(chord.face);
  half.families.push_back(head.family);
  half.arcs.push_back(head.arc);
  LineSegment segment;
  segment.a = head.last_position;
  segment.b = line_point_position(domain_.mesh, chord.to);
  segment.direction = chord.direction.normalized();
  segment.face = chord.face;
  segment.family = head.family;
  proximity_.record(segment, head.sign * (head.arc - 0.5 * (segment.b - segment.a).norm()));
  head.last = chord.to;
  head.last_position = segment.b;
}

void LineWalker::take_back(LineHead& head, std::size_t count, HalfLine& half) {
  proximity_.shrink(proximity_.recorded().size() - count);
  const std::size_t left = half.points.size() - count;
  half.points.resize(left);
  half.faces.resize(left);
  half.families.resize(left);
  half.arcs.resize(left);
  head.last = left > 0 ? half.points.back() : half.origin;
  head.last_position = left > 0 ? line_point_position(domain_.mesh, head.last) : half.seed_position;
}

/// Takes the head over half-edge `h` of its face, where it is.
void LineWalker::enter(LineHead& head, Index h) {
  head.context = unfold_context(domain_, head.context, h);
  head.closed = {domain_.mesh.twin[h], kNone};
  if (domain_.field.cross_extended) return;
  if (head.context.reliable && !head.was_reliable) {  // snap to the closer direction, [MK04] 4.2
    head.family = family_at(domain_, head.context, head.point, head.trusted);
  }
  head.was_reliable = head.context.reliable;
}

/// Prepares to leave the face by half-edge `h`, to which no chord leads from the last point.
bool LineWalker::turn_back(LineHead& head, Index h, HalfLine& half) {
  half.end = LineEnd::stuck;
  if (domain_.mesh.is_barrier(h)) return false;
  // From a vertex the chord starts in the next face around it.
  if (is_vertex_point(head.last)) return true;
  if (half.points.empty()) return false;
  take_back(head, 1, half);
  return true;
}

bool LineWalker::pass_vertex(LineHead& head, Index corner, const Vec2& direction, HalfLine& half) {
  const TriMesh& mesh = domain_.mesh;
  const int i = corner % 3;
  const Vec2 at = head.context.chart.corner[i];
  const Vec2 edge = head.context.chart.corner[(i + 1) % 3] - at;
  const Vec2 back = -direction;
  const double angle =
      std::clamp(std::atan2(cross2(edge, back), edge.dot(back)), 0.0, corner_angle(mesh, corner));
  const Index v = mesh.from(corner);
  const bool barrier = any_outgoing(
      mesh, v, [&](Index h) { return barriers_[h] != 0 || barriers_[TriMesh::prev(h)] != 0; });
  const auto exit = barrier ? std::nullopt : cross_vertex(mesh, corner, angle);
  record(head,
         {{exit ? exit->corner : corner, 0},
          head.context.chart.face,
          world_direction(domain_, head.context, direction)},
         half);
  if (!exit) {
    half.end = mesh.is_boundary(mesh.vertex_out[v]) ? LineEnd::boundary : LineEnd::feature;
    return false;
  }
  head.context = field_context(domain_, TriMesh::face_of(exit->corner));
  const int j = exit->corner % 3;
  head.point = head.context.chart.corner[j];
  const Vec2 base = (head.context.chart.corner[(j + 1) % 3] - head.point).normalized();
  const double c = std::cos(exit->angle);
  const double s = std::sin(exit->angle);
  head.heading = Vec2(c * base.x() - s * base.y(), s * base.x() + c * base.y());
  head.trusted = head.heading;
  head.closed = {exit->corner, TriMesh::prev(exit->corner)};
  return true;
}

bool LineWalker::pass_feature(LineHead& head, Index h, HalfLine& half) {
  const TriMesh& mesh = domain_.mesh;
  half.end = LineEnd::feature;
  head.context = unfold_context(domain_, head.context, h);
  head.closed = {mesh.twin[h], kNone};
  const LineFamily family = family_at(domain_, head.context, head.point, head.heading);
  const Vec2 heading = field_direction(domain_, head.context, head.point, head.heading, family);
  const int j = mesh.twin[h] % 3;
  const Vec2 edge =
      (head.context.chart.corner[(j + 1) % 3] - head.context.chart.corner[j]).normalized();
  const bool is_flat = cross2(edge, heading) < kFlattestCrossing;
  if (is_flat && barriers_[h] != 0) return false;
  if (!is_flat) head.heading = head.trusted = heading;  // else straight on: no line is kept there
  head.family = family;
  return true;
}

bool LineWalker::advance(LineHead& head, Vec2 displacement, HalfLine& half) {
  const TriMesh& mesh = domain_.mesh;
  for (int crossings = 0; crossings < kMostCrossings; ++crossings) {
    auto exit = find_exit(head.context.chart, head.point, displacement, head.closed);
    if (!exit) {
      head.point += displacement;
      head.arc += displacement.norm();
      head.closed = {kNone, kNone};
      return true;
    }
    const Vec2 at = head.point + exit->step * displacement;
    const double travelled = exit->step * displacement.norm();
    const Index h = exit->halfedge;
    const Index face = head.context.chart.face;
    const auto can_reach = [&](const LinePoint& point) {
      return head.last.halfedge == kNone || is_proper_chord(mesh, face, head.last, point);
    };
    if (exit->lambda < kVertexTolerance || exit->lambda > 1 - kVertexTolerance) {
      const Index corner = exit->lambda < 0.5 ? h : TriMesh::next(h);
      if (can_reach(LinePoint{corner, 0})) {
        head.arc += travelled;
        if (!pass_vertex(head, corner, displacement, half)) return false;
        displacement = head.heading * ((1 - exit->step) * displacement.norm());
        continue;
      }
      exit->lambda = std::clamp(exit->lambda, kVertexTolerance, 1 - kVertexTolerance);
    }
    const LinePoint crossing{h, exit->lambda};
    const bool forwards = can_reach(crossing);
    head.arc += travelled;
    if (forwards) {
      record(head, {crossing, face, world_direction(domain_, head.context, displacement)}, half);
    } else if (!turn_back(head, h, half)) {
      return false;
    }
    head.point = at;
    if (forwards && mesh.is_boundary(h)) {
      half.end = LineEnd::boundary;
      return false;
    }
    if (forwards && mesh.is_feature[h] != 0) return pass_feature(head, h, half);
    displacement *= 1 - exit->step;
    enter(head, h);
  }
  return true;
}

}  // namespace strake
