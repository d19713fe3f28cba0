#include "stages/trace/spacing.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "common/geometry/mesh_measures.h"
#include "stages/trace/line_flow.h"

namespace strake {
namespace {

/// Aspect ratio that grading may give to cells where curvature asks for none.
constexpr double kGradedAspect = 2;

/// Radius of what counts as a needle whatever the tolerance, in smallest spacings.
constexpr double kThickestNeedle = 5;

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

/// Keys in the order of their values. They wait by intervals, and only those of the first one are
/// in a heap. No value may be added that is below those taken out last.
class KeyQueue {
 public:
  /// \param width  of the intervals; they are wider where there would be too many
  KeyQueue(double least, double largest, double width)
      : least_(least),
        per_width_(1 / std::max({width, (largest - least) / kMostIntervals,
                                 std::numeric_limits<double>::min()})),
        waiting_(interval_of(largest) + 1) {}

  void push(double value, Index key) {
    const std::size_t interval = interval_of(value);
    if (interval >= next_) {
      waiting_[interval].push_back(key);
    } else {
      heap_.emplace_back(value, key);
      std::ranges::push_heap(heap_, std::greater());
    }
  }

  /// Takes out the key of the least value.
  /// \param value  [keys] the present ones; keys whose value has fallen since are left out
  std::optional<Index> pop(const std::vector<double>& value) {
    while (true) {
      while (!heap_.empty()) {
        std::ranges::pop_heap(heap_, std::greater());
        const auto [pushed, key] = heap_.back();
        heap_.pop_back();
        if (pushed == value[key]) return key;
      }
      if (next_ == waiting_.size()) return std::nullopt;
      for (const Index key : waiting_[next_]) {
        if (interval_of(value[key]) == next_) heap_.emplace_back(value[key], key);
      }
      std::ranges::make_heap(heap_, std::greater());
      std::vector<Index>().swap(waiting_[next_++]);
    }
  }

 private:
  static constexpr double kMostIntervals = 1 << 16;

  [[nodiscard]] std::size_t interval_of(double value) const {
    return static_cast<std::size_t>((value - least_) * per_width_);
  }

  double least_;
  double per_width_;
  std::vector<std::vector<Index>> waiting_;
  std::size_t next_ = 0;  ///< the first interval that waits
  std::vector<std::pair<double, Index>> heap_;
};

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

template <class Use>
void SpacingModel::for_bounded(Index key, const Use& use) const {
  for (Index at = bonds_.first(key / 2); at < bonds_.first(key / 2 + 1); ++at) {
    use(bonds_.bonded(at, key), bonds_.length(at, key / 2));
  }
  bonds_.for_each_tied(key, [&](Index other) { use(other, 0.0); });
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
      return std::max(limits.smallest, limits.scale * wanted);
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

/// Bounds the slope of both spacings by a wave from the smallest values outwards.
void SpacingModel::grade(const SpacingLimits& limits, Spacing& spacing) const {
  const auto keys = static_cast<Index>(2 * areas_.size());
  std::vector<double> value(keys);
  std::vector<double> aspect(areas_.size());
  for (std::size_t w = 0; w < areas_.size(); ++w) {
    value[2 * w] = spacing.along[w];
    value[2 * w + 1] = spacing.across[w];
    // Where the surface itself is not anisotropic, neither should grading make the cells so.
    const auto [small, large] = std::minmax(spacing.along[w], spacing.across[w]);
    aspect[w] = std::max(kGradedAspect, large / small);
  }
  const auto [least, largest] = std::ranges::minmax(value);
  KeyQueue queue(least, largest, limits.gradation * bonds_.mean_length());
  // Start from the values that bound another now; the rest follows in order of size.
  std::vector<std::uint8_t> bounds(keys);
  tbb::parallel_for(Index{0}, keys, [&](Index key) {
    bounds[key] = aspect[key / 2] * value[key] < value[key ^ 1];
    for_bounded(key, [&](Index other, double distance) {
      if (value[key] + limits.gradation * distance < value[other]) bounds[key] = 1;
    });
  });
  for (Index key = 0; key < keys; ++key) {
    if (bounds[key] != 0) queue.push(value[key], key);
  }
  while (const std::optional<Index> next = queue.pop(value)) {
    const Index key = *next;
    const auto lower = [&](Index target, double reach) {
      if (!(reach < value[target])) return;
      value[target] = reach;
      queue.push(reach, target);
    };
    lower(key ^ 1, aspect[key / 2] * value[key]);
    for_bounded(key, [&](Index other, double distance) {
      lower(other, value[key] + limits.gradation * distance);
    });
  }
  for (std::size_t w = 0; w < areas_.size(); ++w) {
    spacing.along[w] = value[2 * w];
    spacing.across[w] = value[2 * w + 1];
  }
}

Spacing SpacingModel::for_tolerance(double tolerance, const SpacingLimits& limits) const {
  Spacing spacing = ungraded(tolerance, limits);
  grade(limits, spacing);
  return spacing;
}

void SpacingModel::follow_lines(double cells, const SpacingLimits& limits, Spacing& spacing) const {
  const double count = predicted_vertices(areas_, spacing);
  strake::follow_lines(mesh_, field_, bonds_, cells, spacing);
  const double factor = std::sqrt(predicted_vertices(areas_, spacing) / count);
  for (auto* distances : {&spacing.along, &spacing.across}) {
    for (double& d : *distances) {
      d = std::max(limits.smallest, std::min(factor * d, limits.scale * limits.largest));
    }
  }
  apply_bounds(limits, spacing);
}

double SpacingModel::tolerance_for_count(double count, const SpacingLimits& limits) const {
  constexpr double kAccuracy = 0.02;
  const double unit = size_ != nullptr ? 1e3 : mesh_.diagonal;
  const double least = std::log(1e-9 * unit);
  const double largest = std::log(0.2 * unit);
  double low = least;
  double high = largest;
  for (int round = 0; round < 10; ++round) {  // without grading: cheap, and not far off
    const double middle = 0.5 * (low + high);
    const Spacing spacing = ungraded(std::exp(middle), limits);
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
  for (int round = 0; round < 12; ++round) {
    const double error =
        std::log(predicted_vertices(areas_, for_tolerance(std::exp(at), limits)) / count);
    if (std::abs(error) < kAccuracy) break;
    (error > 0 ? low : high) = at;
    if (round > 0 && at != last_at) {
      slope = std::clamp((error - last_error) / (at - last_at), -2.0, -0.1);
    }
    last_at = at;
    last_error = error;
    const double next = at - error / slope;
    at = next > low && next < high ? next : 0.5 * (low + high);
  }
  return std::exp(at);
}

}  // namespace strake
