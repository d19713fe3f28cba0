#include "stages/evaluate/measured_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "common/core/disjoint_sets.h"
#include "common/core/error.h"
#include "common/geometry/flat_triangle.h"

namespace strake::evaluation {
namespace {

// The additive recurrence of Roberts (2018) in three dimensions: powers of 1 / g, g^4 = g + 1.
constexpr std::array<double, 3> kStep = {0.8191725133961645, 0.6710436067037893,
                                         0.5497004779019703};

double fraction(double x) { return x - std::floor(x); }

/// Indices of the triangles with an area; none where all have one.
std::vector<Index> triangles_with_area(const std::vector<Vec3>& positions,
                                       const std::vector<std::array<Index, 3>>& triangles,
                                       const char* what) {
  std::vector<Index> kept;
  kept.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    if (is_flat_triangle(positions[a], positions[b], positions[c])) continue;
    kept.push_back(static_cast<Index>(t));
  }
  if (kept.empty()) throw PreconditionError(std::string(what) + " has no face with an area");
  return kept.size() < triangles.size() ? kept : std::vector<Index>();
}

std::vector<std::array<Index, 3>> selected(const std::vector<std::array<Index, 3>>& triangles,
                                           const std::vector<Index>& sources) {
  std::vector<std::array<Index, 3>> result;
  result.reserve(sources.size());
  for (const Index t : sources) result.push_back(triangles[t]);
  return result;
}

}  // namespace

MeasuredSurface::MeasuredSurface(const std::vector<Vec3>& positions,
                                 const std::vector<std::array<Index, 3>>& triangles,
                                 const char* what)
    : sources_(triangles_with_area(positions, triangles, what)),
      kept_(selected(triangles, sources_)),
      distance_(positions, kept_.empty() ? triangles : kept_) {
  const auto count = static_cast<Index>(distance_.triangles().size());
  area_up_to_.reserve(distance_.triangles().size());
  double sum = 0;
  for (Index t = 0; t < count; ++t) {
    sum += cross(t).norm() / 2;
    area_up_to_.push_back(sum);
  }
  DisjointSets sets(static_cast<Index>(positions.size()));
  for (const auto& [a, b, c] : triangles) {
    sets.unite(a, b);
    sets.unite(a, c);
  }
  component_.reserve(positions.size());
  for (Index v = 0; v < std::ssize(positions); ++v) component_.push_back(sets.find(v));
  for (Index t = 0; t < count; ++t) is_one_ = is_one_ && component(t) == component(0);
}

std::vector<Vec3> MeasuredSurface::vertices() const {
  std::vector<std::uint8_t> is_used(distance_.positions().size(), 0);
  for (const auto& triangle : distance_.triangles()) {
    for (const Index v : triangle) is_used[v] = 1;
  }
  std::vector<Vec3> used;
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    if (is_used[v] != 0) used.push_back(distance_.positions()[v]);
  }
  return used;
}

Vec3 MeasuredSurface::cross(Index triangle) const {
  const auto& [a, b, c] = distance_.triangles()[triangle];
  const std::vector<Vec3>& positions = distance_.positions();
  return (positions[b] - positions[a]).cross(positions[c] - positions[a]);
}

SurfaceSample MeasuredSurface::sample(std::int64_t i, std::int64_t n) const {
  const auto number = static_cast<double>(i);
  const double walked =
      area() * (number + fraction(0.5 + number * kStep[0])) / static_cast<double>(n);
  const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end(), walked);
  const auto triangle =
      std::min(static_cast<std::size_t>(found - area_up_to_.begin()), area_up_to_.size() - 1);
  const double root = std::sqrt(fraction(0.5 + number * kStep[1]));
  const double v = fraction(0.5 + number * kStep[2]);
  const auto& corners = distance_.triangles()[triangle];
  const auto& positions = distance_.positions();
  return {(1 - root) * positions[corners[0]] + root * (1 - v) * positions[corners[1]] +
              root * v * positions[corners[2]],
          normal(static_cast<Index>(triangle)), static_cast<Index>(triangle)};
}

}  // namespace strake::evaluation
