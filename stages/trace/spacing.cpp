#include "stages/trace/spacing.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/mesh_measures.h"
#include "stages/trace/grading.h"
#include "stages/trace/line_flow.h"

namespace strake {
namespace {

/// Radius of what counts as a needle whatever the tolerance, in smallest spacings.
constexpr double kThickestNeedle = 5;

/// Share of the vertices at the smallest distances everywhere that a count may ask for.
constexpr double kMostOfSmallest = 0.9;

/// Factor on the distances that curvature gives on needles, which are bent more tightly than the
/// tolerance: less than three lines fit around them, so nothing shows how round they are, and
/// lines at the distance for that would be thousands of rings. 1 elsewhere, and from there on.
double needle_factor(double curvature, double tolerance, const SpacingLimits& limits) {
  const double radius = std::min(tolerance, kThickestNeedle * limits.smallest);
  const double tightness = std::max(1.0, radius * curvature);
  return tightness * tightness;
}

/// |Normal curvature| in the tangent direction `d` of wedge w (Euler's formula).
double normal_curvature(const PrincipalField& field, Index w, const Vec3& d) {
  const double c = field.t_min[w].dot(d);
  const double c2 = std::min(1.0, c * c);
  return std::abs(field.k_min[w] * c2 + field.k_max[w] * (1 - c2));
}

}  // namespace

double spacing_for_curvature(double k, double tolerance, double largest) {
  const double bounded = std::min(std::abs(k), 1.0 / tolerance);
  if (!(bounded > 0)) return largest;
  return std::min(largest, 2 * std::sqrt(tolerance * (2 / bounded - tolerance)));
}

double predicted_vertices(const std::vector<double>& areas, const Spacing& spacing) {
  double sum = 0;
  for (std::size_t w = 0; w < areas.size(); ++w) {
    sum += areas[w] / (spacing.along[w] * spacing.across[w]);
  }
  return sum;
}

SpacingModel::SpacingModel(const TriMesh& mesh, const PrincipalField& field, const SizeField* size)
    : mesh_(mesh), field_(field), size_(size), areas_(wedge_areas(mesh)), bonds_(mesh, field) {
  const Index n = mesh.wedge_count();
  curvature_along_.resize(n);
  curvature_across_.resize(n);
  tbb::parallel_for(Index{0}, n, [&](Index w) {
    curvature_along_[w] = normal_curvature(field, w, field.cross[w]);
    curvature_across_[w] = normal_curvature(field, w, field.normal[w].cross(field.cross[w]));
  });
}

void SpacingModel::bound_along(const std::vector<Index>& halfedges, double length) {
  for (const Index h : halfedges) {
    const Vec3 edge = mesh_.positions[mesh_.to(h)] - mesh_.positions[mesh_.from(h)];
    for (const Index side : {h, mesh_.twin[h]}) {
      if (side == kNone) continue;
      for (const Index corner : {side, TriMesh::next(side)}) {
        bounds_.emplace_back(ArmBonds::key_along(field_, mesh_.wedge_of(corner), edge), length);
      }
    }
  }
}

void SpacingModel::multiply_density(const std::vector<double>& density) {
  shrink_.clear();
  for (const double d : density) shrink_.push_back(1 / std::sqrt(d));
}

Spacing SpacingModel::ungraded(double tolerance, const SpacingLimits& limits) const {
  Spacing spacing;
  spacing.along.resize(areas_.size());
  spacing.across.resize(areas_.size());
  const double size_factor = size_ != nullptr ? std::sqrt(tolerance) : 1;
  tbb::parallel_for(std::size_t{0}, areas_.size(), [&](std::size_t w) {
    const auto distance = [&](double curvature, const std::vector<double> SizeField::*size) {
      const double d = size_ != nullptr
                           ? size_factor * (size_->*size)[w]
                           : needle_factor(curvature, tolerance, limits) *
                                 spacing_for_curvature(curvature, tolerance, limits.largest);
      const double wanted = std::min(limits.largest, shrink_.empty() ? d : shrink_[w] * d);
      return std::max(limits.smallest, std::min(limits.cap, limits.scale * wanted));
    };
    const double a = distance(curvature_along_[w], &SizeField::along);
    const double b = distance(curvature_across_[w], &SizeField::across);
    spacing.along[w] = std::min(a, limits.aspect_ratio * b);
    spacing.across[w] = std::min(b, limits.aspect_ratio * a);
  });
  apply_bounds(limits, spacing);
  return spacing;
}

void SpacingModel::apply_bounds(const SpacingLimits& limits, Spacing& spacing) const {
  for (const auto& [key, length] : bounds_) {
    double& value = key % 2 == 0 ? spacing.along[key / 2] : spacing.across[key / 2];
    const double bound = std::max(1.0, limits.scale) * length;  // gives way to a wanted count
    value = std::min(value, std::max(limits.smallest, bound));
  }
}

Spacing SpacingModel::for_tolerance(double tolerance, const SpacingLimits& limits) const {
  Spacing spacing = ungraded(tolerance, limits);
  grade_spacing(bonds_, limits.gradation, spacing);
  return spacing;
}

void SpacingModel::follow_lines(double cells, const SpacingLimits& limits, Spacing& spacing) const {
  const double count = predicted_vertices(areas_, spacing);
  strake::follow_lines(mesh_, field_, bonds_, cells, spacing);
  const double factor = std::sqrt(predicted_vertices(areas_, spacing) / count);
  for (auto* distances : {&spacing.along, &spacing.across}) {
    for (double& d : *distances) {
      const double largest = std::min(limits.cap, limits.scale * limits.largest);
      d = std::max(limits.smallest, std::min(factor * d, largest));
    }
  }
  apply_bounds(limits, spacing);
}

std::pair<double, Spacing> SpacingModel::for_count(double count,
                                                   const SpacingLimits& limits) const {
  constexpr int kMostRounds = 12;
  constexpr double kAccuracy = 0.02;
  const double unit = size_ != nullptr ? 1e3 : mesh_.diagonal;
  const auto tolerance = [unit](double logarithm) { return unit * std::exp(logarithm); };
  // On needles the smallest distances may give fewer; beyond those no factor would do anything.
  count = std::min(count, kMostOfSmallest * surface_area(mesh_) / std::pow(limits.smallest, 2));
  const double least = std::log(1e-9);
  const double largest = std::log(0.2);
  double low = least;
  double high = largest;
  for (int round = 0; round < 10; ++round) {  // without grading: cheap, and not far off
    const double middle = 0.5 * (low + high);
    const Spacing spacing = ungraded(tolerance(middle), limits);
    (predicted_vertices(areas_, spacing) > count ? low : high) = middle;
  }
  // Counts fall like a power of the tolerance: secant steps between logarithms from there, kept
  // within the bracket.
  double at = 0.5 * (low + high);
  low = least;
  high = largest;
  double slope = -0.8;
  double last_at = 0;
  double last_error = 0;
  for (int round = 0;; ++round) {
    Spacing spacing = for_tolerance(tolerance(at), limits);
    const double error = std::log(predicted_vertices(areas_, spacing) / count);
    if (std::abs(error) < kAccuracy || round == kMostRounds) {
      return {tolerance(at), std::move(spacing)};
    }
    (error > 0 ? low : high) = at;
    if (round > 0 && at != last_at) {
      slope = std::clamp((error - last_error) / (at - last_at), -2.0, -0.1);
    }
    last_at = at;
    last_error = error;
    const double next = at - error / slope;
    at = next > low && next < high ? next : 0.5 * (low + high);
  }
}

}  // namespace strake
