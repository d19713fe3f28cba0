#include "stages/trace/line_tracer.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/line_chord.h"
#include "common/geometry/mesh_measures.h"

namespace strake {
namespace {

/// Crossings nearer to a vertex than this share of the edge pass through the vertex.
constexpr double kVertexTolerance = 1e-3;
constexpr double kStepShare = 0.25;     ///< integration step as a share of the line distance
constexpr double kOwnSkip = 2.0;        ///< stop distances along itself that a line does not see
constexpr int kMaxSteps = 200000;       ///< hard bound on one half line
constexpr int kMaxWalkFaces = 1000;     ///< hard bound on one straight walk
constexpr double kGapRange = 2.0;       ///< line distances within which a gap has its sides
constexpr int kMaxClosingFaces = 2000;  ///< hard bound on the way to the own start
constexpr double kCloseRange = 1.5;     ///< line distances from which a line looks for its start
const double kCloseCosine = std::cos(25 * M_PI / 180);
const double kCloseCosineLast = std::cos(40 * M_PI / 180);
const double kFlattestCrossing = std::sin(20 * M_PI / 180);  ///< with a feature line

/// Weight of the newest direction in the trusted one, "the average of the last few" ([MK04] 4.2).
constexpr double kTrustedShare = 0.3;

double cross2(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

/// The moving end of a line.
struct LineTracer::Head {
  FieldContext context;
  Vec2 point = Vec2::Zero();                     ///< chart
  Vec2 heading = Vec2::Zero();                   ///< chart, unit
  Vec2 trusted = Vec2::Zero();                   ///< chart, average of the last reliable headings
  std::array<Index, 2> closed = {kNone, kNone};  ///< half-edges that are no way out of the face
  LineFamily family = LineFamily::minimum;
  bool was_reliable = true;
  Index line = kNone;
  double arc = 0;            ///< length from the seed
  double sign = 1;           ///< -1 on the backward half
  bool from_corner = false;  ///< whether the line starts at a vertex
  double measure = 0;        ///< length from the seed in units of the distance of crossing lines
  LinePoint last;            ///< last recorded point; halfedge kNone while in the seed's face
  Vec3 last_position;        ///< world, of `last` or the seed
};

/// What one half of a line has recorded so far.
struct LineTracer::HalfLine {
  std::vector<LinePoint> points;
  std::vector<Index> faces;  ///< of the chord that leads to each point
  std::vector<LineFamily> families;
  LineEnd end = LineEnd::stuck;
  std::vector<Seed> candidates;  ///< for lines that cross this one, one per step
  std::vector<double> measures;  ///< where they lie, in units of the wanted distance
  Index seed_face = kNone;
  Vec3 seed_position;
  Vec3 seed_direction;  ///< world, as the half starts
};

LineTracer::LineTracer(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
                       const TracerSettings& settings)
    : domain_(domain),
      barriers_(barriers),
      settings_(settings),
      proximity_(domain.mesh, barriers),
      coverage_(domain) {}

LineTracer::Head LineTracer::start_head(const Seed& seed, bool forward) const {
  const TriMesh& mesh = domain_.mesh;
  Head head;
  Index face = seed.face;
  Vec3 barycentric = seed.barycentric;
  if (seed.anchor.halfedge != kNone && !is_vertex_point(seed.anchor)) {
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
  } else if (seed.anchor.halfedge != kNone) {
    const Index h = seed.anchor.halfedge;
    face = TriMesh::face_of(h);
    barycentric = Vec3::Unit(h % 3);
    head.closed = {h, TriMesh::prev(h)};
    head.from_corner = true;
  }
  head.context = field_context(domain_, face);
  head.point = head.context.chart.point(barycentric);
  Vec2 wanted = chart_direction(domain_, head.context, seed.direction);
  if (!forward) wanted = -wanted;
  if (!(wanted.norm() > 0)) wanted = Vec2(1, 0);
  wanted.normalize();
  head.family = family_at(domain_, head.context, head.point, wanted);
  // From a vertex the way into this face is given; turning it could point into another one.
  head.heading = head.from_corner
                     ? wanted
                     : field_direction(domain_, head.context, head.point, wanted, head.family);
  head.trusted = head.heading;
  head.sign = forward ? 1 : -1;
  head.last = seed.anchor;
  head.last_position = world_point(domain_, head.context, head.point);
  return head;
}

ProximityHit LineTracer::look_around(const Head& head, double fraction,
                                     const LocalSpacing& spacing) {
  ProximityQuery query;
  query.face = head.context.chart.face;
  query.point = world_point(domain_, head.context, head.point);
  query.direction = world_direction(domain_, head.context, head.heading);
  query.radius = spacing.to_neighbours;
  query.distance = fraction * spacing.to_neighbours;
  query.family = head.family;
  query.by_family = !domain_.field.cross_extended && head.context.reliable;
  query.own_line = head.line;
  query.own_arc = head.sign * head.arc;
  query.own_skip = kOwnSkip * query.distance;
  query.ignore_barriers = head.from_corner && head.arc < query.own_skip;
  return proximity_.query(query);
}

/// Whether a line can start here without coming too close to one of its direction.
bool LineTracer::fits(const Head& head, double fraction) {
  const LocalSpacing spacing = spacing_at(domain_, head.context, head.point, head.heading);
  return !look_around(head, fraction, spacing).conflict;
}

/// Distances to the lines of the same direction on the left and right, at most `reach`.
std::pair<double, double> LineTracer::gap_beside(const Head& head, double reach) {
  ProximityQuery query;
  query.face = head.context.chart.face;
  query.point = world_point(domain_, head.context, head.point);
  query.direction = world_direction(domain_, head.context, head.heading);
  query.radius = reach;
  const Vec2 left(-head.heading.y(), head.heading.x());
  return proximity_.distances_beside(query, world_direction(domain_, head.context, left));
}

void LineTracer::cover(const Head& head, const LocalSpacing& spacing) {
  coverage_.mark(proximity_.cell(), world_point(domain_, head.context, head.point),
                 world_direction(domain_, head.context, head.heading),
                 settings_.cover_fraction * spacing.to_neighbours);
}

/// Remembers the present point as a place where a crossing line could start.
void LineTracer::note_candidate(Head& head, const LocalSpacing& spacing, double step,
                                HalfLine& half) const {
  head.measure += step / spacing.along;
  if (!head.context.reliable) return;  // seeds only where directions can be trusted
  Seed seed;
  seed.face = head.context.chart.face;
  seed.barycentric = head.context.chart.barycentric(head.point).cwiseMax(0.0);
  seed.barycentric /= seed.barycentric.sum();
  seed.direction =
      world_direction(domain_, head.context, Vec2(-head.heading.y(), head.heading.x()));
  half.candidates.push_back(seed);
  half.measures.push_back(head.measure);
}

/// Seeds at their wanted distances along a half line; evenly spread where the line is closed.
void LineTracer::spawn(const HalfLine& half, std::vector<Seed>& spawned) {
  if (half.measures.empty()) return;
  const double total = half.measures.back();
  const bool closed = half.end == LineEnd::closed;
  const double distance = closed ? total / std::max(1.0, std::round(total)) : 1.0;
  double next = distance;
  for (std::size_t i = 0; i < half.measures.size(); ++i) {
    if (half.measures[i] < next || (closed && next > total - 0.5 * distance)) continue;
    spawned.push_back(half.candidates[i]);
    next += distance * std::max(1.0, std::floor((half.measures[i] - next) / distance + 1));
  }
}

/// Moves a point along a straight geodesic, up to the first barrier.
void LineTracer::walk_straight(const Vec2& displacement, std::array<Index, 2> closed,
                               FieldContext& context, Vec2& point) const {
  Vec2 rest = displacement;
  for (int guard = 0; guard < kMaxWalkFaces; ++guard) {
    const auto exit = find_exit(context.chart, point, rest, closed);
    if (!exit) {
      point += rest;
      return;
    }
    point += exit->step * rest;
    if (domain_.mesh.is_barrier(exit->halfedge)) return;
    rest *= 1 - exit->step;
    context = unfold_context(domain_, context, exit->halfedge);
    closed = {domain_.mesh.twin[exit->halfedge], kNone};
  }
}

Seed LineTracer::centred(const Seed& seed) {
  const Head head = start_head(seed, true);
  const LocalSpacing spacing = spacing_at(domain_, head.context, head.point, head.heading);
  const double wanted = spacing.to_neighbours;
  const double reach = kGapRange * wanted;
  const auto [to_left, to_right] = gap_beside(head, reach);
  const bool has_left = to_left < reach;
  const bool has_right = to_right < reach;
  const Vec2 left(-head.heading.y(), head.heading.x());
  double shift = 0;
  if (has_left && has_right) {
    shift = 0.5 * (to_left - to_right);
  } else if (has_left || has_right) {
    shift = has_left ? to_left - wanted : wanted - to_right;
  }
  FieldContext context = head.context;
  Vec2 point = head.point;
  walk_straight(left * shift, {kNone, kNone}, context, point);
  Seed moved = seed;
  moved.face = context.chart.face;
  moved.barycentric = context.chart.barycentric(point).cwiseMax(1e-6);
  moved.barycentric /= moved.barycentric.sum();
  moved.direction = world_direction(domain_, context, head.heading);
  return moved;
}

Vec2 LineTracer::runge_kutta(const Head& head, double step) const {
  const auto direction_after = [&](const Vec2& displacement) {
    FieldContext context = head.context;  // the saved context; predictions work on a copy
    Vec2 point = head.point;
    walk_straight(displacement, head.closed, context, point);
    return field_direction(domain_, context, point, displacement.normalized(), head.family);
  };
  const Vec2 k1 = field_direction(domain_, head.context, head.point, head.heading, head.family);
  const Vec2 k2 = direction_after(k1 * (step / 2));
  const Vec2 k3 = direction_after(k2 * (step / 2));
  const Vec2 k4 = direction_after(k3 * step);
  const Vec2 sum = k1 + 2 * k2 + 2 * k3 + k4;
  const double length = sum.norm();
  return length > 0 ? Vec2(sum / length) : k1;
}

bool LineTracer::record(Head& head, const LinePoint& point, const Vec2& at, HalfLine& half) {
  const Index face = head.context.chart.face;
  if (head.last.halfedge != kNone && !is_proper_chord(domain_.mesh, face, head.last, point)) {
    half.end = LineEnd::stuck;  // the line turned back on itself within a face
    return false;
  }
  const Vec3 position = world_point(domain_, head.context, at);
  half.points.push_back(point);
  half.faces.push_back(face);
  half.families.push_back(head.family);
  const Vec3 chord = position - head.last_position;
  const double length = chord.norm();
  if (length > 0) {
    LineSegment segment;
    segment.a = head.last_position;
    segment.b = position;
    segment.direction = chord / length;
    segment.line = head.line;
    segment.arc = head.sign * (head.arc + (at - head.point).norm() / 2);
    segment.family = head.family;
    proximity_.insert(face, segment);
  }
  head.last = point;
  head.last_position = position;
  return true;
}

bool LineTracer::pass_vertex(Head& head, Index corner, const Vec2& direction, HalfLine& half) {
  const TriMesh& mesh = domain_.mesh;
  const int i = corner % 3;
  const Vec2 at = head.context.chart.corner[i];
  const Vec2 edge = head.context.chart.corner[(i + 1) % 3] - at;
  const Vec2 back = -direction;
  const double angle =
      std::clamp(std::atan2(cross2(edge, back), edge.dot(back)), 0.0, corner_angle(mesh, corner));
  const Index v = mesh.from(corner);
  bool barrier = false;
  for (Index h = mesh.vertex_out[v];;) {
    barrier = barrier || barriers_[h] != 0 || barriers_[TriMesh::prev(h)] != 0;
    h = mesh.rotate_ccw(h);
    if (h == kNone || h == mesh.vertex_out[v]) break;
  }
  const auto exit = barrier ? std::nullopt : cross_vertex(mesh, corner, angle);
  if (!exit) {
    if (record(head, LinePoint{corner, 0}, at, half)) {
      half.end = mesh.is_boundary(mesh.vertex_out[v]) ? LineEnd::boundary : LineEnd::feature;
    }
    return false;
  }
  if (!record(head, LinePoint{exit->corner, 0}, at, half)) return false;
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

bool LineTracer::pass_feature(Head& head, Index h, HalfLine& half) {
  const TriMesh& mesh = domain_.mesh;
  half.end = LineEnd::feature;
  head.context = unfold_context(domain_, head.context, h);
  head.closed = {mesh.twin[h], kNone};
  const LineFamily family = family_at(domain_, head.context, head.point, head.heading);
  const Vec2 heading = field_direction(domain_, head.context, head.point, head.heading, family);
  const int j = mesh.twin[h] % 3;
  const Vec2 edge =
      (head.context.chart.corner[(j + 1) % 3] - head.context.chart.corner[j]).normalized();
  if (cross2(edge, heading) < kFlattestCrossing) return false;
  head.heading = heading;
  head.trusted = heading;
  head.family = family;
  return true;
}

/// Moves along a straight geodesic, recording crossings; false where the line ends.
bool LineTracer::advance(Head& head, Vec2 displacement, HalfLine& half) {
  const TriMesh& mesh = domain_.mesh;
  for (;;) {
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
    if (exit->lambda < kVertexTolerance || exit->lambda > 1 - kVertexTolerance) {
      const Index corner = exit->lambda < 0.5 ? h : TriMesh::next(h);
      const LinePoint through{corner, 0};
      if (head.last.halfedge == kNone ||
          is_proper_chord(mesh, head.context.chart.face, head.last, through)) {
        head.arc += travelled;
        if (!pass_vertex(head, corner, displacement, half)) return false;
        displacement = head.heading * ((1 - exit->step) * displacement.norm());
        continue;
      }
      exit->lambda = std::clamp(exit->lambda, kVertexTolerance, 1 - kVertexTolerance);
    }
    if (!record(head, LinePoint{h, exit->lambda}, at, half)) return false;
    head.arc += travelled;
    head.point = at;
    if (mesh.is_boundary(h)) {
      half.end = LineEnd::boundary;
      return false;
    }
    if (mesh.is_feature[h] != 0) return pass_feature(head, h, half);
    displacement *= 1 - exit->step;
    head.context = unfold_context(domain_, head.context, h);
    head.closed = {mesh.twin[h], kNone};
    if (domain_.field.cross_extended) continue;
    if (head.context.reliable && !head.was_reliable) {  // snap to the closer direction, [MK04] 4.2
      head.family = family_at(domain_, head.context, head.point, head.trusted);
    }
    head.was_reliable = head.context.reliable;
  }
}

bool LineTracer::try_close(const Head& start, const LocalSpacing& spacing, double least_cosine,
                           HalfLine& half) {
  if (half.points.empty() || !proximity_.in_cell(half.seed_face)) return false;
  const Vec3 here = world_point(domain_, start.context, start.point);
  const Vec3 heading = world_direction(domain_, start.context, start.heading);
  const Vec3 way = half.seed_position - here;
  const double distance = way.norm();
  if (distance > kCloseRange * spacing.to_neighbours || !(distance > 0)) return false;
  if (heading.dot(half.seed_direction) < least_cosine) return false;
  if (heading.dot(way) < least_cosine * distance) return false;

  Head head = start;
  const std::size_t points_before = half.points.size();
  const std::size_t segments_before = proximity_.segment_count();
  const LinePoint first = half.points.front();
  for (int guard = 0; guard < kMaxClosingFaces; ++guard) {
    if (head.context.chart.face == half.seed_face) {
      if (!is_proper_chord(domain_.mesh, half.seed_face, half.points.back(), first)) break;
      half.end = LineEnd::closed;
      return true;
    }
    const Vec3 rest = half.seed_position - world_point(domain_, head.context, head.point);
    const Vec2 flat = chart_direction(domain_, head.context, rest);
    const auto exit = find_exit(head.context.chart, head.point, flat, head.closed);
    if (!exit || domain_.mesh.is_barrier(exit->halfedge)) break;
    const double lambda = std::clamp(exit->lambda, kVertexTolerance, 1 - kVertexTolerance);
    const Vec2 at = head.point + exit->step * flat;
    if (!record(head, LinePoint{exit->halfedge, lambda}, at, half)) break;
    head.point = at;
    head.context = unfold_context(domain_, head.context, exit->halfedge);
    head.closed = {domain_.mesh.twin[exit->halfedge], kNone};
  }
  proximity_.remove_last(proximity_.segment_count() - segments_before);
  half.points.resize(points_before);
  half.faces.resize(points_before);
  half.families.resize(points_before);
  return false;
}

void LineTracer::trace_half(Head head, bool may_close, HalfLine& half) {
  half.end = LineEnd::step_limit;
  int standing = 0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const LocalSpacing spacing = spacing_at(domain_, head.context, head.point, head.heading);
    const ProximityHit hit = look_around(head, settings_.stop_fraction, spacing);
    const bool far_from_start = head.arc > 2 * kCloseRange * spacing.to_neighbours;
    if (may_close && far_from_start && try_close(head, spacing, kCloseCosine, half)) return;
    if (hit.conflict && head.arc > 0) {
      if (may_close && hit.own && try_close(head, spacing, kCloseCosineLast, half)) return;
      half.end = LineEnd::proximity;
      return;
    }
    cover(head, spacing);
    const double length = kStepShare * std::min(spacing.to_neighbours, spacing.along);
    const Vec2 direction = runge_kutta(head, length);
    if (head.context.reliable) {
      head.trusted = ((1 - kTrustedShare) * head.trusted + kTrustedShare * direction).normalized();
    }
    head.heading = head.context.reliable ? direction : head.trusted;
    const double before = head.arc;
    if (!advance(head, head.heading * length, half)) return;
    note_candidate(head, spacing, head.arc - before, half);
    standing = head.arc - before > 1e-3 * length ? 0 : standing + 1;
    if (standing > 4) {
      half.end = LineEnd::stuck;
      return;
    }
  }
}

bool LineTracer::join(const HalfLine& forward, const HalfLine& backward, const Seed& seed,
                      TracedLine& result) const {
  const bool anchored = seed.anchor.halfedge != kNone;
  const auto append = [&](const LinePoint& p, Index face, LineFamily family) {
    result.points.push_back(p);
    result.chord_face.push_back(face);
    result.chord_family.push_back(family);
  };
  for (std::size_t i = backward.points.size(); i-- > 0;) {
    append(backward.points[i], backward.faces[i], backward.families[i]);
  }
  result.seed_point = static_cast<Index>(result.points.size());
  if (anchored) append(seed.anchor, forward.seed_face, result.family);
  for (std::size_t i = 0; i < forward.points.size(); ++i) {
    const bool last = i + 1 == forward.points.size();
    append(forward.points[i], last ? kNone : forward.faces[i + 1],
           last ? forward.families[i] : forward.families[i + 1]);
  }
  if (result.points.size() < 2) return false;
  result.seed_point = std::min(result.seed_point, static_cast<Index>(result.points.size()) - 1);
  if (forward.end == LineEnd::closed) {
    result.chord_face.back() = forward.seed_face;
  } else {
    result.chord_face.back() = kNone;
  }
  if (!anchored && !backward.points.empty() && !forward.points.empty() &&
      !is_proper_chord(domain_.mesh, forward.seed_face, backward.points.front(),
                       forward.points.front())) {
    return false;
  }
  return true;
}

bool LineTracer::trace(const Seed& seed, Index line, TracedLine& result,
                       std::vector<Seed>& spawned) {
  Head head = start_head(seed, true);
  head.line = line;
  const double fraction = seed.fills_gap ? settings_.gap_fraction : settings_.seed_fraction;
  if (!fits(head, fraction)) return false;
  const std::size_t segments_before = proximity_.segment_count();
  const std::size_t spawned_before = spawned.size();
  HalfLine forward;
  HalfLine backward;
  const bool anchored = seed.anchor.halfedge != kNone;
  forward.seed_face = head.context.chart.face;
  forward.seed_position = head.last_position;
  forward.seed_direction = world_direction(domain_, head.context, head.heading);
  const LocalSpacing spacing = spacing_at(domain_, head.context, head.point, head.heading);
  result.family = head.family;
  trace_half(head, !anchored, forward);
  spawn(forward, spawned);
  const bool has_other_side = !anchored || (!is_vertex_point(seed.anchor) &&
                                            !domain_.mesh.is_boundary(seed.anchor.halfedge));
  if (forward.end != LineEnd::closed && has_other_side) {
    Head back = start_head(seed, false);
    back.line = line;
    if (!anchored) {
      back.heading = -head.heading;
      back.trusted = back.heading;
      back.family = head.family;
    }
    backward.seed_face = back.context.chart.face;
    if (!anchored || fits(back, fraction)) {
      trace_half(back, false, backward);
      spawn(backward, spawned);
    } else {
      backward.end = LineEnd::feature;
    }
  } else if (anchored) {
    backward.end =
        domain_.mesh.is_boundary(seed.anchor.halfedge) ? LineEnd::boundary : LineEnd::feature;
  }
  result.start_reason = forward.end == LineEnd::closed ? LineEnd::closed : backward.end;
  result.end_reason = forward.end;

  double length = 0;
  const bool joined = join(forward, backward, seed, result);
  for (std::size_t i = 1; joined && i < result.points.size(); ++i) {
    length += (line_point_position(domain_.mesh, result.points[i]) -
               line_point_position(domain_.mesh, result.points[i - 1]))
                  .norm();
  }
  const bool crosses_barriers = result.start_reason != LineEnd::proximity &&
                                result.end_reason != LineEnd::proximity && joined;
  if (!joined || (length < spacing.along && !crosses_barriers)) {
    proximity_.remove_last(proximity_.segment_count() - segments_before);
    spawned.resize(spawned_before);
    return false;
  }
  return true;
}

}  // namespace strake
