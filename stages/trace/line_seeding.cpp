#include "stages/trace/line_seeding.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace strake {
namespace {

constexpr double kGapRange = 2.0;  ///< line distances within which a gap has its sides

Vec2 left_of(const Vec2& heading) { return {-heading.y(), heading.x()}; }

/// Puts a seed where a chart point is, at least `inside` away from the edges (barycentric).
void place(const FieldContext& context, const Vec2& point, double inside, Seed& seed) {
  seed.face = context.chart.face;
  seed.barycentric = context.chart.barycentric(point).cwiseMax(inside);
  seed.barycentric /= seed.barycentric.sum();
}

/// For lines of a head's direction near to it.
ProximityQuery look_around(const TraceDomain& domain, const LineHead& head, double reach) {
  ProximityQuery query;
  query.face = head.context.chart.face;
  query.point = world_point(domain, head.context, head.point);
  query.direction = world_direction(domain, head.context, head.heading);
  query.distance = reach;
  return query;
}

}  // namespace

void CrossingSeeds::note(const TraceDomain& domain, const LineHead& head, double distance,
                         double step) {
  measure_ += step / distance;
  if (!head.context.reliable) return;  // seeds only where directions can be trusted
  Seed seed;
  place(head.context, head.point, 0, seed);
  seed.direction = world_direction(domain, head.context, left_of(head.heading));
  seeds_.push_back(seed);
  measures_.push_back(measure_);
}

void CrossingSeeds::shorten(std::size_t count) {
  if (count >= seeds_.size()) return;
  seeds_.resize(count);
  measures_.resize(count);
  measure_ = measures_.empty() ? 0 : measures_.back();
}

void CrossingSeeds::spawn(bool closed, std::vector<Seed>& spawned) const {
  if (measures_.empty()) return;
  const double total = measures_.back();
  const double distance = closed ? total / std::max(1.0, std::round(total)) : 1.0;
  double next = distance;
  for (std::size_t i = 0; i < measures_.size(); ++i) {
    if (measures_[i] < next || (closed && next > total - 0.5 * distance)) continue;
    spawned.push_back(seeds_[i]);
    next += distance * std::max(1.0, std::floor((measures_[i] - next) / distance + 1));
  }
}

LineGap gap_beside(const TraceDomain& domain, const LineHead& head, ProximityProbe& proximity) {
  LineGap gap;
  gap.wanted = spacing_at(domain, head).to_neighbours;
  gap.reach = kGapRange * gap.wanted;
  std::tie(gap.to_left, gap.to_right) =
      proximity.distances_beside(look_around(domain, head, gap.reach),
                                 world_direction(domain, head.context, left_of(head.heading)));
  return gap;
}

double share_to_nearest(const TraceDomain& domain, const LineHead& head,
                        ProximityProbe& proximity) {
  const double wanted = spacing_at(domain, head).to_neighbours;
  return proximity.query(look_around(domain, head, kGapRange * wanted)).distance / wanted;
}

Seed centred(const TraceDomain& domain, const Seed& seed, ProximityProbe& proximity) {
  const LineHead head = start_head(domain, seed, true);
  const LineGap gap = gap_beside(domain, head, proximity);
  const bool has_left = gap.to_left < gap.reach;
  const bool has_right = gap.to_right < gap.reach;
  double shift = 0;
  if (has_left && has_right) {
    shift = 0.5 * (gap.to_left - gap.to_right);
  } else if (has_left || has_right) {
    shift = has_left ? gap.to_left - gap.wanted : gap.wanted - gap.to_right;
  }
  FieldContext context = head.context;
  Vec2 point = head.point;
  walk_straight(domain, left_of(head.heading) * shift, {kNone, kNone}, context, point);
  Seed moved = seed;
  place(context, point, 1e-6, moved);
  moved.direction = world_direction(domain, context, head.heading);
  return moved;
}

}  // namespace strake
