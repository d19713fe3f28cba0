#include "stages/trace/line_closing.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/geometry/line_chord.h"
#include "common/geometry/segment.h"

namespace strake {
namespace {

constexpr int kMaxClosingFaces = 2000;  ///< hard bound on the way to the own start
constexpr double kCloseRange = 1.5;     ///< line distances from which a line looks for its start

/// A straight way from a head to the start of its line.
struct WayHome {
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

std::optional<WayHome> way_home(const TraceDomain& domain, const LineHead& head,
                                const HalfLine& half, const Target& target) {
  const TriMesh& mesh = domain.mesh;
  WayHome way;
  way.kept = half.points.size();
  FieldContext context = head.context;
  Vec2 point = head.point;
  std::array<Index, 2> closed = head.closed;
  for (int guard = 0; guard < kMaxClosingFaces; ++guard) {
    const Index face = context.chart.face;
    const LinePoint last = way.chords.empty() ? half.points[way.kept - 1] : way.chords.back().to;
    if (face == target.face && is_proper_chord(mesh, face, last, half.points[target.end])) {
      return way;
    }
    const Vec2 flat =
        chart_direction(domain, context, target.position - world_point(domain, context, point));
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
    } else if (--way.kept <= target.end + 1) {
      return std::nullopt;
    }
    point += exit->step * flat;
    context = unfold_context(domain, context, exit->halfedge);
    closed = {mesh.twin[exit->halfedge], kNone};
  }
  return std::nullopt;
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
  std::optional<WayHome> way;
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
  LineHead end = head;
  walker.take_back(end, half.points.size() - way->kept, half);
  for (const Chord& chord : way->chords) {
    end.arc += (line_point_position(domain.mesh, chord.to) - end.last_position).norm();
    walker.record(end, chord, half);
  }
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

}  // namespace strake
