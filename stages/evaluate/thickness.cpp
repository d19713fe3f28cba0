#include "stages/evaluate/thickness.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/place_text.h"

namespace strake::evaluation {
namespace {

/// Share of a thickness by which it may change: that of a square in place of a circle does by 0.3.
constexpr double kMayChange = 0.35;
/// Cosine of the angle by which two sides may differ from parallel ones: those of rods of five
/// sides and more do by 36 degrees at most. What is farther open, as along the edge of a groove or
/// a wedge, ends in an edge and is as thin as one looks near to that.
constexpr double kAgainst = 0.8;
/// Change that nobody sees, in lengths of cells, and area with a larger one, in those of cells.
constexpr double kUnseen = 0.1;
constexpr double kFewCells = 0.15;
/// Samples that may be chance: at many cells those of such an area are fewer than one.
constexpr std::int64_t kFewSamples = 2;

/// What is seen from a place through the body; model units.
struct Through {
  double thickness = 0;  ///< 0: no other side within a cell
  double now = 0;        ///< in the candidate
  double change = 0;     ///< no more than both ends are off the candidate
};

/// The nearest place that faces a direction; its triangle is kNone where none is within reach.
/// \param component  of which it is to be; kNone: of any
ClosestPoint facing(const MeasuredSurface& surface, const Vec3& p, const Vec3& way, double reach,
                    Index component) {
  return surface.distance().closest_if(p, reach, [&](Index triangle) {
    return surface.normal(triangle).dot(way) > 0 &&
           (component == kNone || surface.component(triangle) == component);
  });
}

/// How far the two sides of one component of the candidate are apart; 0 where one is not found.
double distance_between(const ThicknessRequest& request, const SurfaceSample& at,
                        const Vec3& opposite, Index component) {
  const MeasuredSurface& candidate = request.candidate;
  const ClosestPoint front = facing(candidate, at.position, at.normal, request.cell, component);
  const ClosestPoint back = facing(candidate, opposite, -at.normal, request.cell, component);
  if (front.triangle == kNone || back.triangle == kNone) return 0;
  const Vec3 way = candidate.distance().point(front) - candidate.distance().point(back);
  return std::max(way.dot(at.normal), 0.0);
}

/// What a thickness became: where parts touch or lie in each other, in the component of the place
/// nearest to the front or to the back, whichever is more like it.
double thickness_now(const ThicknessRequest& request, const SurfaceSample& at, const Vec3& opposite,
                     double thickness) {
  if (request.reference.is_one() || request.candidate.is_one()) {
    return distance_between(request, at, opposite, kNone);
  }
  const MeasuredSurface& candidate = request.candidate;
  double now = 0;
  for (const ClosestPoint& end : {facing(candidate, at.position, at.normal, request.cell, kNone),
                                  facing(candidate, opposite, -at.normal, request.cell, kNone)}) {
    if (end.triangle == kNone) continue;
    const double own = distance_between(request, at, opposite, candidate.component(end.triangle));
    if (std::abs(own - thickness) < std::abs(now - thickness)) now = own;
  }
  return now;
}

double least_change(double thickness, double cell) {
  return std::max(kMayChange * thickness, kUnseen * cell);
}

Through look_through(const ThicknessRequest& request, const SurfaceSample& at) {
  const Index own = request.reference.component(at.triangle);
  const double thickness = request.reference.distance().distance_to_back(
      at.position, -at.normal, request.cell, kAgainst,
      [&](Index triangle) { return request.reference.component(triangle) == own; });
  if (std::isinf(thickness)) return {};
  const SurfaceDistance& candidate = request.candidate.distance();
  const Vec3 opposite = at.position - thickness * at.normal;
  const double off = candidate.closest(at.position).distance + candidate.closest(opposite).distance;
  if (off <= least_change(thickness, request.cell)) return {thickness, thickness, 0};
  const double now = thickness_now(request, at, opposite, thickness);
  return {thickness, now, std::min(std::abs(thickness - now), off)};
}

}  // namespace

void report_thickness(const ThicknessRequest& request, Report& report) {
  std::vector<Through> seen(static_cast<std::size_t>(request.samples));
  tbb::parallel_for(std::int64_t{0}, request.samples, [&](std::int64_t i) {
    seen[i] = look_through(request, request.reference.sample(i, request.samples));
  });
  std::int64_t thin = 0;
  std::int64_t changed = 0;
  std::int64_t worst = 0;
  for (std::int64_t i = 0; i < request.samples; ++i) {
    if (seen[i].thickness > 0) ++thin;
    if (seen[i].change <= least_change(seen[i].thickness, request.cell)) continue;
    ++changed;
    if (changed == 1 || seen[i].change > seen[worst].change) worst = i;
  }
  const auto samples = static_cast<double>(request.samples);
  const double share = static_cast<double>(changed) / samples;
  report.set("thickness.thin_share", static_cast<double>(thin) / samples);
  report.set("thickness.changed_share", share);
  const double cells = share * request.reference.area() / (request.cell * request.cell);
  if (changed <= kFewSamples || cells <= kFewCells) return;
  const Vec3 place = request.reference.sample(worst, request.samples).position + request.origin;
  report.set("thickness.worst", seen[worst].thickness);
  report.set("thickness.worst_now", seen[worst].now);
  report.warn(fmt::format(
      "a part that is {:.3g} thick at {} is {:.3g} thick there now, and "
      "{:.2g} % of the surface is of parts that changed like that: they are thinner than faces are "
      "long; ask for more vertices, or for a smaller tolerance",
      seen[worst].thickness, place_text(place, request.diagonal), seen[worst].now, 100 * share));
}

}  // namespace strake::evaluation
