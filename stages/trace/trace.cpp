#include "stages/trace/trace.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "common/core/error.h"
#include "common/geometry/border_course.h"
#include "common/geometry/density.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/topology/topology.h"
#include "stages/trace/barrier_lines.h"
#include "stages/trace/line_collector.h"
#include "stages/trace/line_count.h"
#include "stages/trace/spacing.h"

namespace strake {
namespace {

constexpr Length kDefaultTolerance = percent(0.1);
/// The errors of the two families of lines add up in the middle of a cell.
constexpr double kShareOfFamily = 0.5;
constexpr Length kDefaultMaxSpacing = percent(5);  ///< [MK04] section 3.2, at the default tolerance
constexpr double kStopFractionOfDensity = 0.6;
constexpr double kFarTooMany = 4;          ///< vertices, over those wanted
constexpr double kLargestCell = 3;         ///< in mean cell lengths, where a count is wanted
constexpr double kSmallestSpacing = 1e-4;  ///< share of the diagonal
constexpr Index kSeedsPerComponent = 8;
constexpr int kTriesPerSeed = 32;
/// Times that lines are traced again for a count, and error of it, as a share, that is small
/// enough: the count that lines give is only known to a tenth.
constexpr int kMostCorrections = 3;
constexpr double kCountAccuracy = 0.03;

/// How strongly the directions at a face can be trusted: relative anisotropy times confidence.
double reliability(const TriMesh& mesh, const PrincipalField& field, Index f) {
  double sum = 0;
  for (const Index w : mesh.face_wedges[f]) {
    sum += std::abs(field.k_max[w] - field.k_min[w]);
  }
  return sum * field.face_confidence[f];
}

/// Sparse random seeds where directions are most reliable ([MK04] section 3), some per component.
std::vector<Seed> random_seeds(const TraceDomain& domain, std::int64_t random_seed) {
  const std::vector<Index> component = face_components(domain.mesh);
  std::vector<std::vector<Index>> faces(*std::max_element(component.begin(), component.end()) + 1);
  for (Index f = 0; f < domain.mesh.face_count(); ++f) faces[component[f]].push_back(f);
  std::mt19937_64 random(static_cast<std::uint64_t>(random_seed));
  std::vector<std::pair<double, Seed>> seeds;
  for (const auto& pool : faces) {
    for (Index k = 0; k < kSeedsPerComponent; ++k) {
      Index best = kNone;
      double best_value = -1;
      for (int attempt = 0; attempt < kTriesPerSeed; ++attempt) {
        const Index f = pool[random() % pool.size()];
        const double value = reliability(domain.mesh, domain.field, f);
        if (value > best_value) {
          best_value = value;
          best = f;
        }
      }
      Seed seed;
      seed.face = best;
      seed.direction = domain.field.cross[domain.mesh.face_wedges[best][0]];
      seeds.emplace_back(best_value, seed);
    }
  }
  std::stable_sort(seeds.begin(), seeds.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Seed> result;
  for (auto& [value, seed] : seeds) result.push_back(seed);
  return result;
}

/// Largest distance between lines that stands for a tolerance. Where that is wider than the default
/// one it grows as distances on bends do, with the root; flats would have most of the lines else.
double largest_spacing(double tolerance, double diagonal) {
  const double ratio = tolerance / kDefaultTolerance.resolve(diagonal);
  return kDefaultMaxSpacing.resolve(diagonal) * std::sqrt(std::max(1.0, ratio));
}

/// Vertices or faces that are wanted: of almost only quads there are about as many of both.
std::optional<double> wanted_count(const TraceOptions& options) {
  if (options.vertices) return static_cast<double>(*options.vertices);
  if (options.faces) return static_cast<double>(*options.faces);
  return std::nullopt;
}

/// \param least  vertices where all lines are as far apart as they may be
/// \throw UsageError where that are more than are wanted
void require_room(double least, double count, const TraceOptions& options) {
  constexpr double kClearly = 1.1;
  if (least <= kClearly * count) return;
  throw UsageError("lines at most " + options.max_spacing->to_string() +
                   " apart (--max-spacing) give " + std::to_string(std::llround(least)) +
                   " vertices or more, and " + std::to_string(std::llround(count)) +
                   " are wanted; leave one of them out");
}

/// Refuses distances that nobody can have meant: of a few hundred faces, lines for many millions of
/// vertices take hours and more memory than there is.
/// \param vertices  that these distances give, about
/// \throw UsageError
void require_sense(double vertices, const TriMesh& mesh, const TraceOptions& options) {
  constexpr double kMany = 2e6;
  constexpr double kTimesFaces = 100;
  const double most = std::max(
      {kMany, kTimesFaces * mesh.face_count(), kFarTooMany * wanted_count(options).value_or(0)});
  if (vertices <= most) return;
  throw UsageError(
      "lines as close as asked for (--max-spacing, --spacing-scale, --tolerance or a "
      "density) give about " +
      std::to_string(std::llround(vertices)) + " vertices, of a mesh of " +
      std::to_string(mesh.face_count()) +
      " faces; give them more room, or the count with --vertices");
}

/// How far lines are to be apart, but for a factor on all distances.
class WantedSpacing {
 public:
  WantedSpacing(const TriMesh& mesh, const PrincipalField& field, const WantedSizes& sizes,
                const TraceOptions& options)
      : model_(mesh, field, sizes.size),
        // What a user says of distances or of lines counts more than where lines end.
        line_flow_(sizes.density == nullptr && field.guides.line_count() == 0 ? options.line_flow
                                                                              : 0) {
    const double tolerance = options.tolerance.value_or(kDefaultTolerance).resolve(mesh.diagonal);
    limits_.smallest = kSmallestSpacing * mesh.diagonal;
    if (options.max_spacing) {
      limits_.largest = limits_.cap = options.max_spacing->resolve(mesh.diagonal);
    } else {  // that of a size field is in it already
      limits_.largest = sizes.size != nullptr ? std::numeric_limits<double>::infinity()
                                              : largest_spacing(tolerance, mesh.diagonal);
    }
    // A size field was made from distances that had the density in them already.
    if (sizes.density != nullptr && sizes.size == nullptr) {
      model_.multiply_density(density_at_wedges(mesh, *sizes.density));
    }
    bound_rings(mesh, model_);
    tolerance_of_family_ = sizes.size != nullptr ? 1 : kShareOfFamily * tolerance;
    if (const auto count = wanted_count(options)) {
      const double area = surface_area(mesh);
      if (options.max_spacing) require_room(area / std::pow(limits_.largest, 2), *count, options);
      // Relative to the mean cell: flats may be coarse, but not out of proportion.
      if (!options.max_spacing) limits_.largest = kLargestCell * std::sqrt(area / *count);
      const auto [tolerance_of_count, spacing] = model_.for_count(*count, limits_);
      tolerance_of_family_ = tolerance_of_count;
      // They are capped before a density divides them, so no tolerance may give so few.
      const double excess = predicted_vertices(model_.areas(), spacing) / *count;
      if (excess > kFarTooMany) own_scale_ = std::sqrt(excess);
    }
  }

  /// \param scale  factor on all distances, positive
  [[nodiscard]] Spacing at(double scale) const {
    SpacingLimits limits = limits_;
    limits.scale = scale * own_scale_;
    Spacing spacing = model_.for_tolerance(tolerance_of_family_, limits);
    if (line_flow_ > 0) model_.follow_lines(line_flow_, limits, spacing);
    return spacing;
  }

  /// Vertices to expect of distances.
  [[nodiscard]] double vertices(const Spacing& spacing) const {
    return predicted_vertices(model_.areas(), spacing);
  }

  /// The tolerance that the distances stand for, model units.
  [[nodiscard]] double tolerance() const { return tolerance_of_family_ / kShareOfFamily; }

 private:
  SpacingModel model_;
  double line_flow_;
  SpacingLimits limits_;
  double tolerance_of_family_ = 0;
  double own_scale_ = 1;  ///< factor on all distances besides that asked for
};

/// Height of teeth of ragged boundaries over the middle that lines need not follow, model units.
double largest_teeth(const TriMesh& mesh, const TraceOptions& options) {
  if (!options.tolerance) return std::numeric_limits<double>::infinity();
  return kCourseOfTolerance * options.tolerance->resolve(mesh.diagonal);
}

/// Seeds on guide lines, from the middle of each: lines along them come first. All places are
/// tried, for guides that are bent more than lines can be, and so need several.
void seed_on_guides(const LaidGuides& guides, std::vector<Seed>& seeds) {
  const auto add = [&](Index piece) {
    Seed seed;
    seed.face = guides.face[piece];
    seed.barycentric = guides.barycentric[piece].cwiseMax(1e-6);
    seed.barycentric /= seed.barycentric.sum();
    seed.direction = guides.step[piece];
    seeds.push_back(seed);
  };
  for (Index g = 0; g < guides.line_count(); ++g) {
    add((guides.offsets[g] + guides.offsets[g + 1]) / 2);
  }
  for (Index piece = 0; piece < guides.piece_count(); ++piece) add(piece);
}

/// Seeds on guides, at corners, along feature and boundary lines, and at random, in the order to be
/// tried.
std::vector<Seed> first_seeds(const TraceDomain& domain, const std::vector<BarrierLine>& barriers,
                              const std::vector<std::uint8_t>& flags, std::int64_t random_seed) {
  std::vector<Seed> seeds;
  seed_on_guides(domain.field.guides, seeds);
  seed_at_corners(domain, flags, seeds);
  for (const BarrierLine& line : barriers) seed_along(domain, line, seeds);
  const std::vector<Seed> anisotropic = random_seeds(domain, random_seed);
  seeds.insert(seeds.end(), anisotropic.begin(), anisotropic.end());
  return seeds;
}

TraceResult trace_at(const TriMesh& mesh, const PrincipalField& field, const WantedSpacing& wanted,
                     double scale, const TraceOptions& options, const WantedSizes& sizes,
                     Observer& observer) {
  observer.report("choosing line distances", 0);
  Spacing spacing = wanted.at(scale);
  require_sense(wanted.vertices(spacing), mesh, options);
  const TraceDomain domain{
      mesh, field, spacing, FaceNormals(mesh),
      border_course(mesh, sizes_at_vertices(mesh, spacing.along, spacing.across),
                    largest_teeth(mesh, options))};
  TracerSettings settings;
  settings.stop_fraction = options.stop_fraction.value_or(
      sizes.density != nullptr ? kStopFractionOfDensity : settings.stop_fraction);
  const std::vector<BarrierLine> barriers = barrier_lines(domain);
  const std::vector<std::uint8_t> flags = barrier_flags(mesh, barriers);
  LineCollector collector(domain, flags, settings, observer);
  for (const BarrierLine& line : barriers) collector.add(to_traced_line(line));
  collector.grow(first_seeds(domain, barriers, flags, options.seed));
  collector.saturate();

  TraceResult result;
  result.lines = std::move(collector.lines());
  result.lines.mesh_id = mesh.id;
  Index closed = 0;
  for (Index l = static_cast<Index>(barriers.size()); l < result.lines.line_count(); ++l) {
    closed += result.lines.is_closed(l);
  }
  // Sizes say by themselves what is wanted where.
  if (sizes.size == nullptr) result.report.set("trace.tolerance", wanted.tolerance());
  result.report.set("trace.spacing_scale", scale);
  result.report.set("trace.lines", static_cast<std::int64_t>(result.lines.line_count()));
  result.report.set("trace.feature_and_boundary_lines", barriers.size());
  result.report.set("trace.closed_lines", static_cast<std::int64_t>(closed));
  result.report.set("trace.crossings", result.lines.points.size());
  result.report.set("trace.largest_gap", collector.largest_gap());
  result.report.set("trace.seeds_tried", collector.tried());
  result.report.set("trace.proximity_queries", collector.query_count());
  result.lines.spacing_along_min = std::move(spacing.along);
  result.lines.spacing_along_max = std::move(spacing.across);
  return result;
}

}  // namespace

TraceResult trace_lines(const TriMesh& mesh, const PrincipalField& field,
                        const TraceOptions& options, Observer& observer, const WantedSizes& sizes) {
  const int goals = int(options.tolerance.has_value()) + int(options.vertices.has_value()) +
                    int(options.faces.has_value());
  if (goals > 1) throw UsageError("give only one of --tolerance, --vertices and --faces");
  const WantedSpacing spacing(mesh, field, sizes, options);
  const auto trace = [&](double scale) {
    return trace_at(mesh, field, spacing, scale, options, sizes, observer);
  };
  const std::optional<double> wanted = wanted_count(options);
  if (!wanted || options.spacing_scale) return trace(options.spacing_scale.value_or(1));
  TraceResult best;
  double least_miss = std::numeric_limits<double>::infinity();
  double scale = 1;
  for (int round = 0; round <= kMostCorrections; ++round) {
    TraceResult traced = trace(scale);
    const LineCount count = count_places(mesh, traced.lines);
    const double miss = std::abs(static_cast<double>(count.vertices()) / *wanted - 1);
    scale *= scale_for(count, *wanted);
    if (miss < least_miss) {
      least_miss = miss;
      best = std::move(traced);
    }
    if (least_miss <= kCountAccuracy) break;
  }
  return best;
}

}  // namespace strake
