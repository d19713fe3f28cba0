#include "stages/evaluate/deviation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <string>

#include "common/geometry/angles.h"
#include "stages/evaluate/statistics.h"

namespace strake::evaluation {
namespace {

constexpr double kOnEdge = 1e-7;      // barycentric; nearer than this to an edge is on it
constexpr double kSamePlace = 1e-10;  // of the diagonal; distances that differ by less are equal
constexpr std::int64_t kBatch = 1 << 16;  // between two reports of progress
constexpr std::size_t kClimbs = 32;       // triangles in which the farthest place is looked for
constexpr std::size_t kLookedAt = 256;    // samples, the farthest, of which these are
constexpr double kClimbedTo = 1e-3;       // of the distance between samples
constexpr double kNoFarther = 1e-6;       // as a share
constexpr int kMostSteps = 100;           // of a climb; on a needle it would have no end

const Vec3& position_of(const SurfaceSample& sample) { return sample.position; }
const Vec3& position_of(const Vec3& place) { return place; }

struct OneWay {
  double mean = 0, rms = 0;
  Farthest farthest;
  double normal_mean = 0, normal_rms = 0, normal_max = 0, facing_away = 0;  // degrees; a share
};

/// The nearest points of a surface to n places, in parallel, with progress.
/// \param place  (i) -> the place; those that follow each other are often near each other
/// \param use    (i, place, foot); results must go to places of their own
template <class Place, class Use>
void find_feet(std::int64_t n, const SurfaceDistance& surface, const char* phase,
               Observer& observer, const Place& place, const Use& use) {
  using Range = tbb::blocked_range<std::int64_t>;
  for (std::int64_t begin = 0; begin < n; begin += kBatch) {
    observer.report(phase, static_cast<double>(begin) / static_cast<double>(n));
    tbb::parallel_for(Range(begin, std::min(n, begin + kBatch)), [&](const Range& some) {
      Index guess = kNone;
      for (std::int64_t i = some.begin(); i < some.end(); ++i) {
        const auto& sample = place(i);
        const ClosestPoint foot = surface.closest_near(position_of(sample), guess);
        guess = foot.triangle;
        use(i, sample, foot);
      }
    });
  }
}

double degrees_between(const Vec3& a, const Vec3& b) {
  return angle_between(a, b) * 180 / std::numbers::pi;
}

/// The angle between a sample's normal and the surface's at the sample's foot.
///
/// Where the foot lies on an edge or vertex, as it does for all samples beyond a convex edge, the
/// surface has several normals there and rounding would choose: the one nearest to the sample's
/// counts.
double normal_deviation(const SurfaceSample& sample, const MeasuredSurface& to,
                        const ClosestPoint& foot, double tolerance) {
  double least = degrees_between(sample.normal, to.normal(foot.triangle));
  const auto& weights = foot.barycentric;
  if (*std::min_element(weights.begin(), weights.end()) > kOnEdge) return least;
  const SurfaceDistance& distance = to.distance();
  const double reach = foot.distance + tolerance;
  const auto look_at = [&](Index t) {
    const auto& [a, b, c] = distance.triangles()[t];
    const auto& p = distance.positions();
    if (closest_point_on_triangle(sample.position, p[a], p[b], p[c]).distance <= reach) {
      least = std::min(least, degrees_between(sample.normal, to.normal(t)));
    }
    return false;  // keeps the reach as it is, so that every triangle within is looked at
  };
  static_cast<void>(distance.closest_if(sample.position, reach, look_at));
  return least;
}

/// Samples with the largest distances, the largest first, one of a triangle.
std::vector<SurfaceSample> farthest_samples(const MeasuredSurface& from,
                                            const std::vector<double>& distance) {
  const auto samples = static_cast<std::int64_t>(distance.size());
  const auto is_farther = [&](std::int64_t i, std::int64_t j) {
    return distance[i] != distance[j] ? distance[i] > distance[j] : i < j;
  };
  std::set<std::int64_t, decltype(is_farther)> farthest(is_farther);
  for (std::int64_t i = 0; i < samples; ++i) {
    const bool is_full = farthest.size() == kLookedAt;
    if (is_full && !is_farther(i, *farthest.rbegin())) continue;
    farthest.insert(i);
    if (is_full) farthest.erase(std::prev(farthest.end()));
  }
  std::vector<SurfaceSample> starts;
  for (const std::int64_t i : farthest) {
    const SurfaceSample sample = from.sample(i, samples);
    const bool is_first =
        std::ranges::find(starts, sample.triangle, &SurfaceSample::triangle) == starts.end();
    if (is_first && starts.size() < kClimbs) starts.push_back(sample);
  }
  return starts;
}

/// Goes from a sample, within its triangle, to where the distance is largest: to the best of eight
/// places around, nearer and nearer ones.
/// \param step  to the first places, model units
Farthest climb(const SurfaceDistance& from, const SurfaceDistance& to, const SurfaceSample& start,
               double step) {
  const auto& [a, b, c] = from.triangles()[start.triangle];
  const std::vector<Vec3>& p = from.positions();
  const Vec3 x = (p[b] - p[a]).normalized();
  const Vec3 y = start.normal.cross(x);
  ClosestPoint foot = to.closest(start.position);
  Farthest best{foot.distance, start.position};
  const double least = kClimbedTo * step;
  for (int steps = 0; step > least && steps < kMostSteps; ++steps) {
    const Farthest before = best;
    for (int turn = 0; turn < 8; ++turn) {
      const double angle = turn * std::numbers::pi / 4;
      const Vec3 aim = before.place + step * (std::cos(angle) * x + std::sin(angle) * y);
      const auto& weights = closest_point_on_triangle(aim, p[a], p[b], p[c]).barycentric;
      const Vec3 place = weights[0] * p[a] + weights[1] * p[b] + weights[2] * p[c];
      foot = to.closest_near(place, foot.triangle);
      if (foot.distance > best.distance) best = {foot.distance, place};
    }
    if (best.distance <= (1 + kNoFarther) * before.distance) step /= 2;
  }
  return best;
}

/// The largest distance near the samples that have the largest.
Farthest beyond_samples(const MeasuredSurface& from, const MeasuredSurface& to,
                        const std::vector<double>& distance) {
  const std::vector<SurfaceSample> starts = farthest_samples(from, distance);
  const double step = std::sqrt(from.area() / static_cast<double>(distance.size()));
  std::vector<Farthest> found(starts.size());
  tbb::parallel_for(std::size_t{0}, starts.size(), [&](std::size_t i) {
    found[i] = climb(from.distance(), to.distance(), starts[i], step);
  });
  return *std::ranges::max_element(found, {}, &Farthest::distance);
}

OneWay measure(const SurfaceWithVertices& from, const MeasuredSurface& to, double diagonal,
               std::int64_t samples, const char* phase, Observer& observer) {
  std::vector<double> distance(static_cast<std::size_t>(samples));
  std::vector<double> angle(distance.size());
  find_feet(
      samples, to.distance(), phase, observer,
      [&](std::int64_t i) { return from.surface.sample(i, samples); },
      [&](std::int64_t i, const SurfaceSample& sample, const ClosestPoint& foot) {
        distance[i] = foot.distance;
        angle[i] = normal_deviation(sample, to, foot, kSamePlace * diagonal);
      });
  std::vector<double> at_vertex(from.vertices.size());
  find_feet(
      static_cast<std::int64_t>(at_vertex.size()), to.distance(), phase, observer,
      [&](std::int64_t i) -> const Vec3& { return from.vertices[i]; },
      [&](std::int64_t i, const Vec3&, const ClosestPoint& foot) { at_vertex[i] = foot.distance; });

  OneWay result;
  result.mean = mean(distance);
  result.rms = rms(distance);
  result.farthest = beyond_samples(from.surface, to, distance);
  const auto of_vertices = std::ranges::max_element(at_vertex);
  if (of_vertices != at_vertex.end() && *of_vertices >= result.farthest.distance) {
    result.farthest = {*of_vertices, from.vertices[of_vertices - at_vertex.begin()]};
  }
  result.normal_mean = mean(angle);
  result.normal_rms = rms(angle);
  result.normal_max = largest(angle);
  const auto away = std::count_if(angle.begin(), angle.end(), [](double a) { return a > 90; });
  result.facing_away = share(static_cast<double>(away), static_cast<double>(samples));
  return result;
}

OneWay both(const OneWay& a, const OneWay& b) {
  OneWay result;
  result.mean = (a.mean + b.mean) / 2;
  result.rms = std::sqrt((a.rms * a.rms + b.rms * b.rms) / 2);
  result.farthest = a.farthest.distance >= b.farthest.distance ? a.farthest : b.farthest;
  result.normal_mean = (a.normal_mean + b.normal_mean) / 2;
  result.normal_rms = std::sqrt((a.normal_rms * a.normal_rms + b.normal_rms * b.normal_rms) / 2);
  result.normal_max = std::max(a.normal_max, b.normal_max);
  result.facing_away = (a.facing_away + b.facing_away) / 2;
  return result;
}

void report_way(const std::string& way, const OneWay& measured, double diagonal, Report& report) {
  const std::string distance = "distance." + way;
  report.set(distance + "rms", measured.rms);
  report.set(distance + "mean", measured.mean);
  report.set(distance + "max", measured.farthest.distance);
  report.set(distance + "rms_share", share(measured.rms, diagonal));
  report.set(distance + "mean_share", share(measured.mean, diagonal));
  report.set(distance + "max_share", share(measured.farthest.distance, diagonal));
  const std::string normals = "normals." + way;
  report.set(normals + "mean_deg", measured.normal_mean);
  report.set(normals + "rms_deg", measured.normal_rms);
  report.set(normals + "max_deg", measured.normal_max);
  report.set(normals + "facing_away_share", measured.facing_away);
}

}  // namespace

Farthest report_deviation(const SurfaceWithVertices& reference,
                          const SurfaceWithVertices& candidate, double diagonal,
                          std::int64_t samples, Observer& observer, Report& report) {
  const OneWay to_reference = measure(candidate, reference.surface, diagonal, samples,
                                      "distances to the reference", observer);
  const OneWay from_reference = measure(reference, candidate.surface, diagonal, samples,
                                        "distances from the reference", observer);
  report.set("distance.samples", samples);
  const OneWay both_ways = both(to_reference, from_reference);
  report_way("", both_ways, diagonal, report);
  report_way("to_reference.", to_reference, diagonal, report);
  report_way("from_reference.", from_reference, diagonal, report);
  return both_ways.farthest;
}

}  // namespace strake::evaluation
