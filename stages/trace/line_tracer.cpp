#include "stages/trace/line_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/geometry/line_chord.h"
#include "stages/trace/line_ends.h"
#include "stages/trace/line_progress.h"

namespace strake {
namespace {

constexpr double kStepShare = 0.25;    ///< integration step as a share of the line distance
constexpr double kCoverStep = 0.4;     ///< line distances between discs that a line covers
constexpr double kOwnSkip = 2.0;       ///< stop distances along itself that a line does not see
constexpr double kWayOut = 1.2;        ///< stop distances at which a line is out of narrows
constexpr double kTurnedRound = -0.5;  ///< cosine to its first direction of a line on its way round
constexpr double kLongestNarrows = 30;   ///< line distances that a line may run in narrows
constexpr int kMaxSteps = 200000;        ///< hard bound on one half line
constexpr std::size_t kStepsPerGap = 4;  ///< between places where a finished line is judged

/// Weight of the newest direction in the trusted one, "the average of the last few" ([MK04] 4.2).
constexpr double kTrustedShare = 0.3;

/// Joins two halves of a line at their seed; false where no chord leads through the seed's face.
bool join(const TriMesh& mesh, const HalfLine& forward, const HalfLine& backward, const Seed& seed,
          TracedLine& result) {
  const auto append = [&](const LinePoint& p, Index face, LineFamily family) {
    result.points.push_back(p);
    result.chord_face.push_back(face);
    result.chord_family.push_back(family);
  };
  for (std::size_t i = backward.points.size(); i-- > 0;) {
    append(backward.points[i], backward.faces[i], backward.families[i]);
  }
  result.seed_point = static_cast<Index>(result.points.size());
  if (seed.is_anchored()) {
    const Index face = forward.faces.empty() ? forward.seed_face : forward.faces.front();
    append(seed.anchor, face, result.family);
  }
  for (std::size_t i = 0; i < forward.points.size(); ++i) {
    const bool last = i + 1 == forward.points.size();
    append(forward.points[i], last ? kNone : forward.faces[i + 1],
           last ? forward.families[i] : forward.families[i + 1]);
  }
  if (result.points.size() < 2) return false;
  result.seed_point = std::min(result.seed_point, static_cast<Index>(result.points.size()) - 1);
  result.chord_face.back() = forward.end == LineEnd::closed ? forward.faces.front() : kNone;
  return seed.is_anchored() || backward.points.empty() || forward.points.empty() ||
         is_proper_chord(mesh, forward.seed_face, backward.points.front(), forward.points.front());
}

double length_of(const TriMesh& mesh, const TracedLine& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    length +=
        (line_point_position(mesh, line.points[i]) - line_point_position(mesh, line.points[i - 1]))
            .norm();
  }
  return length;
}

}  // namespace

LineTracer::LineTracer(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
                       const TracerSettings& settings, const FinishedLines& finished)
    : domain_(domain),
      settings_(settings),
      finished_(finished),
      proximity_(finished.proximity()),
      walker_(domain, barriers, proximity_) {}

ProximityQuery LineTracer::query_at(const LineHead& head, double fraction,
                                    const LocalSpacing& spacing) const {
  ProximityQuery query;
  query.face = head.context.chart.face;
  query.point = world_point(domain_, head.context, head.point);
  query.direction = world_direction(domain_, head.context, head.heading);
  query.distance = fraction * spacing.to_neighbours;
  query.family = head.family;
  query.by_family = !domain_.field.cross_extended && head.context.reliable;
  query.own_arc = head.sign * head.arc;
  query.own_skip = kOwnSkip * query.distance;
  query.ignore_barriers = head.from_corner && head.arc < query.own_skip;
  return query;
}

ProximityHit LineTracer::look_around(const LineHead& head, double fraction,
                                     const LocalSpacing& spacing) {
  return proximity_.query(query_at(head, fraction, spacing));
}

/// Whether a line can start here without coming too close to one of its direction.
bool LineTracer::fits(const LineHead& head, double fraction) {
  return !look_around(head, fraction, spacing_at(domain_, head)).conflict;
}

/// Discs that lie so far apart cover the strip of that width beside the line.
void LineTracer::cover(const LineHead& head, const LocalSpacing& spacing) {
  covered_.push_back(
      {head.context.chart.face, world_point(domain_, head.context, head.point),
       world_direction(domain_, head.context, head.heading),
       std::hypot(settings_.cover_fraction, kCoverStep / 2) * spacing.to_neighbours});
}

/// Whether a line that is too close to another one may get out of these narrows again.
bool LineTracer::may_go_on(const LineHead& head, const ProximityHit& hit,
                           const LocalSpacing& spacing, double narrows_arc) const {
  return hit.line != kOwnLine &&
         hit.distance >= settings_.narrow_fraction * spacing.to_neighbours &&
         head.arc - narrows_arc <= kLongestNarrows * spacing.to_neighbours;
}

/// Ends a half line where its narrows begin.
void LineTracer::turn_back(const Narrows& narrows, LineHead& head, HalfLine& half) {
  // One crossing may have been undone since.
  if (half.points.size() > narrows.points) {
    walker_.take_back(head, half.points.size() - narrows.points, half);
  }
  half.crossings.shorten(narrows.places);
  half.stopped_by = narrows.stopped_by;
  half.end = LineEnd::proximity;
}

/// Ends a half line at a corner of features or boundaries straight ahead that no other line comes
/// between: what follows there is alike and would stop it just before.
bool LineTracer::meets_corner(const LineHead& head, ProximityQuery query, HalfLine& half) {
  const Index corner = proximity_.corner_ahead(query, kAheadCosine);
  if (corner == kNone) return false;
  query.distance = (domain_.mesh.positions[corner] - query.point).norm();
  query.ignore_barriers = true;
  return !proximity_.query(query).conflict && end_at_corner(domain_, walker_, head, corner, half);
}

void LineTracer::trace_half(LineHead head, bool may_close, double stop_fraction, HalfLine& half) {
  half.end = LineEnd::step_limit;
  LineProgress progress(head);
  std::optional<Narrows> narrows;
  bool is_away = false;  // on its way round: around a thin tube, to where its start is soon
  double next_disc = head.arc;
  const auto closes = [&](double least_cosine) {
    return may_close && close_line(domain_, proximity_, walker_, head, least_cosine, half);
  };
  for (int step = 0; step < kMaxSteps; ++step) {
    const LocalSpacing spacing = spacing_at(domain_, head);
    const ProximityQuery query = query_at(head, stop_fraction, spacing);
    const ProximityHit hit = proximity_.query(query);
    const bool may_meet_corner = hit.conflict ? hit.line == kNone : query.ignore_barriers;
    if (may_meet_corner && head.arc > 0 && meets_corner(head, query, half)) return;
    is_away = is_away || query.direction.dot(half.seed_direction) < kTurnedRound;
    const bool may_be_back = is_away || can_close(head, spacing);
    if (may_be_back && closes(kAheadCosine)) return;
    if (hit.conflict && head.arc > 0) {
      if ((may_be_back || hit.line == kOwnLine) && closes(kAheadCosineLast)) return;
      if (!narrows) narrows = {head.arc, half.points.size(), half.crossings.all().size(), hit.line};
      const bool comes_home =
          may_close && is_away && hit.line == kOwnLine &&
          query.direction.dot(half.seed_position - query.point) > 0;  // not past its start
      if (!comes_home && !may_go_on(head, hit, spacing, narrows->arc)) {
        turn_back(*narrows, head, half);
        return;
      }
    } else if (narrows && !look_around(head, kWayOut * stop_fraction, spacing).conflict) {
      narrows.reset();
    }
    if (!narrows && head.arc >= next_disc) {
      cover(head, spacing);
      next_disc = head.arc + kCoverStep * spacing.to_neighbours;
    }
    const double length = kStepShare * std::min(spacing.to_neighbours, spacing.along);
    const Vec2 direction = runge_kutta(domain_, head, length);
    if (head.context.reliable) {
      head.trusted = ((1 - kTrustedShare) * head.trusted + kTrustedShare * direction).normalized();
    }
    head.heading = head.context.reliable ? direction : head.trusted;
    const double before = head.arc;
    if (!walker_.advance(head, head.heading * length, half)) return;
    half.crossings.note(domain_, head, spacing.along, head.arc - before);
    const LineProgress::State state =
        progress.after_step(domain_.mesh, head, half, length, head.arc - before,
                            kOwnSkip * stop_fraction * spacing.to_neighbours);
    if (state == LineProgress::State::gets_on) continue;
    if (state == LineProgress::State::winds) {
      walker_.take_back(head, half.points.size() - progress.good_points(), half);
      half.crossings.shorten(progress.good_places());
    }
    half.end = LineEnd::stuck;
    return;
  }
}

std::optional<LineTracer::Halves> LineTracer::trace_halves(const Seed& seed, double stop_fraction) {
  const LineHead head = start_head(domain_, seed, true);
  const double fraction = seed.fills_gap ? settings_.gap_fraction : settings_.seed_fraction;
  if (!fits(head, fraction)) return std::nullopt;
  HalfLine forward(domain_, head);
  trace_half(head, !seed.is_anchored(), stop_fraction, forward);

  const bool at_border = seed.is_anchored() && domain_.mesh.is_boundary(seed.anchor.halfedge);
  const bool has_other_side = !seed.is_anchored() || (!is_vertex_point(seed.anchor) && !at_border);
  LineHead back = has_other_side ? start_head(domain_, seed, false) : head;
  if (!seed.is_anchored()) {
    back.heading = -head.heading;
    back.trusted = back.heading;
    back.family = head.family;
  }
  HalfLine backward(domain_, back);
  backward.end = at_border ? LineEnd::boundary : LineEnd::feature;
  if (forward.end == LineEnd::closed) {
    backward.end = LineEnd::closed;
  } else if (has_other_side && (!seed.is_anchored() || fits(back, fraction))) {
    trace_half(back, false, stop_fraction, backward);
  }
  return Halves{std::move(forward), std::move(backward), spacing_at(domain_, head).along,
                head.family};
}

/// Whether a line ends on both sides beside closed lines, or beside its own other end.
bool LineTracer::is_arc_among_rings(const Halves& halves) const {
  const auto stops_there = [&](const HalfLine& half) {
    return half.end == LineEnd::proximity &&
           (half.stopped_by == kOwnLine || finished_.is_ring(half.stopped_by));
  };
  return stops_there(halves.forward) && stops_there(halves.backward);
}

/// The widest gap between the lines on both sides of a half line, in wanted distances; 0 where
/// its directions cannot be trusted anywhere.
double LineTracer::widest_gap(const HalfLine& half) {
  double widest = 0;
  const std::vector<Seed>& places = half.crossings.all();
  for (std::size_t i = 0; i < places.size(); i += kStepsPerGap) {
    LineHead head = start_head(domain_, places[i], true);
    head.heading = Vec2(head.heading.y(), -head.heading.x());
    const LineGap gap = gap_beside(domain_, head, proximity_);
    widest = std::max(widest, (gap.to_left + gap.to_right) / gap.wanted);
  }
  return widest;
}

/// What becomes of an arc between closed lines: among rings it should be one, or not be at all.
///
/// Where no seed would have been placed to fill its gap it is left out. Else it may go on through
/// narrows from the middle of the gap, and stays an arc where that does not close it.
std::optional<LineTracer::Halves> LineTracer::trace_ring(const Seed& seed, const Halves& arc) {
  const std::size_t arc_segments = proximity_.recorded().size();
  const double gap = std::max(widest_gap(arc.forward), widest_gap(arc.backward));
  proximity_.shrink(0);
  const bool is_alone = arc.forward.stopped_by == kOwnLine && arc.backward.stopped_by == kOwnLine;
  if (gap < 2 * settings_.gap_fraction && !is_alone) return std::nullopt;
  const double fraction = std::min(settings_.narrow_fraction, settings_.stop_fraction);
  auto ring = trace_halves(centred(domain_, seed, proximity_), fraction);
  // A line that only meets itself is a ring all but closed, or a spiral, as on a knotted tube: that
  // must not wind on more closely.
  const std::size_t longest = is_alone ? 3 * arc_segments / 2 : SIZE_MAX;
  if (ring && ring->forward.end == LineEnd::closed && ring->forward.points.size() <= longest) {
    return ring;
  }
  proximity_.shrink(0);
  return trace_halves(seed, settings_.stop_fraction);
}

/// Joins the halves; false where they make no line that can stay.
bool LineTracer::finish(const Seed& seed, const Halves& halves, LineDraft& draft) const {
  const auto& [forward, backward, spacing_along, family] = halves;
  draft.line.family = family;
  draft.line.start_reason = backward.end;
  draft.line.end_reason = forward.end;
  if (!join(domain_.mesh, forward, backward, seed, draft.line)) return false;
  const bool ends_near_a_line =
      backward.end == LineEnd::proximity || forward.end == LineEnd::proximity;
  if (ends_near_a_line && length_of(domain_.mesh, draft.line) < spacing_along) return false;
  forward.crossings.spawn(forward.end == LineEnd::closed, draft.spawned);
  backward.crossings.spawn(false, draft.spawned);
  return true;
}

LineDraft LineTracer::trace(const Seed& seed) {
  proximity_.clear();
  covered_.clear();
  LineDraft draft;
  std::optional<Halves> halves = trace_halves(seed, settings_.stop_fraction);
  if (halves && !seed.is_anchored() && is_arc_among_rings(*halves)) {
    halves = trace_ring(seed, *halves);
  }
  draft.is_line = halves && finish(seed, *halves, draft);
  if (draft.is_line) draft.segments = proximity_.recorded();
  draft.covered = covered_;
  draft.query_count = proximity_.query_count();
  return draft;
}

}  // namespace strake
