#include "stages/trace/spacing.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"

namespace strake {
namespace {

/// Normal curvature in the tangent direction `d` of wedge w (Euler's formula).
double normal_curvature(const PrincipalField& field, Index w, const Vec3& d) {
  const double c = field.t_min[w].dot(d);
  const double c2 = std::min(1.0, c * c);
  return field.k_min[w] * c2 + field.k_max[w] * (1 - c2);
}

/// Bounds the slope of both spacings by a wave from the smallest values outwards; the arms of
/// neighbouring crosses are matched by direction.
void grade(const TriMesh& mesh, const PrincipalField& field, double slope, Spacing& spacing) {
  const Index n = mesh.wedge_count();
  const auto value = [&](Index key) -> double& {
    return key < n ? spacing.along[key] : spacing.across[key - n];
  };
  std::vector<Index> corner_offsets(n + 1, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) ++corner_offsets[mesh.wedge_of(h) + 1];
  for (Index w = 0; w < n; ++w) corner_offsets[w + 1] += corner_offsets[w];
  std::vector<Index> corners(mesh.halfedge_count());
  std::vector<Index> fill(corner_offsets.begin(), corner_offsets.end() - 1);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) corners[fill[mesh.wedge_of(h)]++] = h;

  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto relax_from = [&](Index key) {
    const Index w = key < n ? key : key - n;
    const double here = value(key);
    for (Index at = corner_offsets[w]; at < corner_offsets[w + 1]; ++at) {
      const Index h = corners[at];
      for (const Index other : {TriMesh::next(h), TriMesh::prev(h)}) {
        const Index v = mesh.wedge_of(other);
        const double reach = here + slope * (mesh.positions[mesh.from(other)] -
                                             mesh.positions[mesh.from(h)]).norm();
        const Vec3 arm = rotate_between(field.normal[w], field.normal[v], field.cross[w]);
        const bool same = std::abs(arm.dot(field.cross[v])) >= M_SQRT1_2;
        const Index target = same == (key < n) ? v : v + n;
        if (reach < value(target)) {
          value(target) = reach;
          queue.emplace(reach, target);
        }
      }
    }
  };
  for (Index key = 0; key < 2 * n; ++key) relax_from(key);
  while (!queue.empty()) {
    const auto [reached, key] = queue.top();
    queue.pop();
    if (reached > value(key)) continue;
    relax_from(key);
  }
}

}  // namespace

double spacing_for_curvature(double k, double tolerance, double largest) {
  const double bounded = std::min(std::abs(k), 1.0 / tolerance);
  if (!(bounded > 0)) return largest;
  return std::min(largest, 2 * std::sqrt(tolerance * (2 / bounded - tolerance)));
}

Spacing spacing_for_tolerance(const TriMesh& mesh, const PrincipalField& field, double tolerance,
                              const SpacingLimits& limits) {
  const Index n = mesh.wedge_count();
  Spacing spacing;
  spacing.along.resize(n);
  spacing.across.resize(n);
  const auto distance = [&](Index w, const Vec3& arm) {
    const double d =
        spacing_for_curvature(normal_curvature(field, w, arm), tolerance, limits.largest);
    return std::max(d, limits.smallest);
  };
  for (Index w = 0; w < n; ++w) {
    const double a = distance(w, field.cross[w]);
    const double b = distance(w, field.normal[w].cross(field.cross[w]));
    spacing.along[w] = std::min(a, limits.aspect_ratio * b);
    spacing.across[w] = std::min(b, limits.aspect_ratio * a);
  }
  grade(mesh, field, limits.gradation, spacing);
  return spacing;
}

double predicted_vertices(const std::vector<double>& areas, const Spacing& spacing) {
  double sum = 0;
  for (std::size_t w = 0; w < areas.size(); ++w) sum += areas[w] / (spacing.along[w] * spacing.across[w]);
  return sum;
}

double tolerance_for_count(const TriMesh& mesh, const PrincipalField& field, double count,
                           const SpacingLimits& limits) {
  const std::vector<double> areas = wedge_areas(mesh);
  double low = std::log(1e-9 * mesh.diagonal);
  double high = std::log(0.2 * mesh.diagonal);
  for (int round = 0; round < 18; ++round) {
    const double middle = 0.5 * (low + high);
    const Spacing spacing = spacing_for_tolerance(mesh, field, std::exp(middle), limits);
    (predicted_vertices(areas, spacing) > count ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

}  // namespace strake
