#include "stages/trace/line_ends.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/geometry/line_chord.h"
#include "common/geometry/segment.h"

namespace strake {
namespace {

constexpr int kMaxClosingFaces = 2000;  ///< hard bound on the way to the own start or a corner
constexpr double kCloseRange = 1.5;     ///< line distances from which a line looks for its start

/// A straight way from a head to the start of its line, or to a corner.
struct StraightWay {
  std::size_t kept = 0;  ///< points of the line that stay; the way may turn back at once
  std::vector<Chord> chords;
};

/// A chord in the line's first points, and where on it the way home aims at.
struct Target {
  std::size_t end = 0;  ///< point of the line where the chord ends
  Index face = kNone;
  Vec3 position;
};

Target target_chord(const TraceDomain& domain, const HalfLine& half, std::size_t end) {
  Target target{end, half.faces[end], half.seed_position};
  if (end > 0) {
    target.position = 0.5 * (line_point_position(domain.mesh, half.points[end - 1]) +
                             line_point_position(domain.mesh, half.points[end]));
  }
  return target;
}

/// Whether an edge of a face is within a distance of a point. From farther off the straight way
/// home would stray from the field.
bool is_near(const TriMesh& mesh, Index face, const Vec3& point, double distance) {
  for (Index h = 3 * face; h < 3 * face + 3; ++h) {
    const Vec3 way =
        way_to_segment(point, mesh.positions[mesh.from(h)], mesh.positions[mesh.to(h)]);
    if (way.squaredNorm() <= distance * distance) return true;
  }
  return false;
}

/// Whether the head is on its way to the target.
bool heads_for(const TraceDomain& domain, const LineHead& head, const HalfLine& half,
               const Target& target, double reach, double least_cosine) {
  const Vec3 heading = world_direction(domain, head.context, head.heading);
  const Vec3 way = target.position - world_point(domain, head.context, head.point);
  const double distance = way.norm();
  return distance <= reach && distance > 0 && heading.dot(half.seed_direction) >= least_cosine &&
         heading.dot(way) >= least_cosine * distance;
}

/// \param target  position to go to
/// \param fewest  points of the line that must stay
/// \param arrives  (face, last point): whether the way ends in that face
template <class Arrives>
std::optional<StraightWay> straight_way(const TraceDomain& domain, const LineHead& head,
                                        const HalfLine& half, const Vec3& target,
                                        std::size_t fewest, const Arrives& arrives) {
  const TriMesh& mesh = domain.mesh;
  StraightWay way;
  way.kept = half.points.size();
  FieldContext context = head.context;
  Vec2 point = head.point;
  std::array<Index, 2> closed = head.closed;
  for (int guard = 0; guard < kMaxClosingFaces; ++guard) {
    const Index face = context.chart.face;
    const LinePoint last = !way.chords.empty() ? way.chords.back().to
                           : way.kept > 0      ? half.points[way.kept - 1]
                                               : half.origin;
    if (arrives(face, last)) return way;
    const Vec2 flat =
        chart_direction(domain, context, target - world_point(domain, context, point));
    const auto exit = find_exit(context.chart, point, flat, closed);
    if (!exit || mesh.is_barrier(exit->halfedge)) return std::nullopt;
    const LinePoint crossing{exit->halfedge,
                             std::clamp(exit->lambda, kVertexTolerance, 1 - kVertexTolerance)};
    if (is_proper_chord(mesh, face, last, crossing)) {
      way.chords.push_back({crossing, face, world_direction(domain, context, flat)});
    } else if (is_vertex_point(last)) {
      // The chord from a vertex starts in the next face around it.
    } else if (!way.chords.empty()) {
      way.chords.pop_back();
    } else if (way.kept <= fewest) {
      return std::nullopt;
    } else {
      --way.kept;
    }
    point += exit->step * flat;
    context = unfold_context(domain, context, exit->halfedge);
    closed = {mesh.twin[exit->halfedge], kNone};
  }
  return std::nullopt;
}

std::optional<StraightWay> way_home(const TraceDomain& domain, const LineHead& head,
                                    const HalfLine& half, const Target& target) {
  return straight_way(domain, head, half, target.position, target.end + 2,
                      [&](Index face, const LinePoint& last) {
                        return face == target.face &&
                               is_proper_chord(domain.mesh, face, last, half.points[target.end]);
                      });
}

/// Takes back what does not stay, and goes the way.
void go(const TraceDomain& domain, LineWalker& walker, const LineHead& head, const StraightWay& way,
        HalfLine& half) {
  LineHead end = head;
  walker.take_back(end, half.points.size() - way.kept, half);
  for (const Chord& chord : way.chords) {
    end.arc += (line_point_position(domain.mesh, chord.to) - end.last_position).norm();
    walker.record(end, chord, half);
  }
}

}  // namespace

bool can_close(const LineHead& head, const LocalSpacing& spacing) {
  return head.arc > 2 * kCloseRange * spacing.to_neighbours;
}

bool close_line(const TraceDomain& domain, ProximityProbe& proximity, LineWalker& walker,
                const LineHead& head, double least_cosine, HalfLine& half) {
  const double distance = spacing_at(domain, head).to_neighbours;
  const double reach = kCloseRange * distance;
  const Index face = head.context.chart.face;
  const Vec3 point = world_point(domain, head.context, head.point);
  std::optional<StraightWay> way;
  std::size_t joined = 0;
  for (; joined + 2 < half.points.size(); ++joined) {
    const Target target = target_chord(domain, half, joined);
    if ((target.position - half.seed_position).norm() > reach) return false;
    if (!is_near(domain.mesh, target.face, point, distance) ||
        !heads_for(domain, head, half, target, reach, least_cosine) ||
        !proximity.can_reach(face, point, distance, target.face)) {
      continue;
    }
    way = way_home(domain, head, half, target);
    if (way) break;
  }
  if (!way) return false;
  go(domain, walker, head, *way, half);
  // Their segments stay in the proximity index, where they stand for the last chord.
  const auto drop = [&](auto& values) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(joined));
  };
  drop(half.points);
  drop(half.faces);
  drop(half.families);
  drop(half.arcs);
  half.end = LineEnd::closed;
  return true;
}

bool end_at_corner(const TraceDomain& domain, LineWalker& walker, const LineHead& head,
                   Index corner, HalfLine& half) {
  const TriMesh& mesh = domain.mesh;
  if (half.points.empty() && half.origin.halfedge == kNone) return false;
  Chord last;
  last.to.lambda = 0;
  const auto arrives = [&](Index face, const LinePoint& from) {
    last.face = face;
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      last.to.halfedge = h;
      if (mesh.from(h) == corner) return is_proper_chord(mesh, face, from, last.to);
    }
    return false;
  };
  const Vec3& target = mesh.positions[corner];
  std::optional<StraightWay> way = straight_way(
      domain, head, half, target, std::min<std::size_t>(1, half.points.size()), arrives);
  if (!way) return false;
  last.direction = target - world_point(domain, head.context, head.point);
  way->chords.push_back(last);
  go(domain, walker, head, *way, half);
  half.end = mesh.is_boundary(mesh.vertex_out[corner]) ? LineEnd::boundary : LineEnd::feature;
  return true;
}

}  // namespace strake
