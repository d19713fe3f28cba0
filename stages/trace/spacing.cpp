#include "stages/trace/spacing.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"

namespace strake {
namespace {

/// Aspect ratio that grading may give to cells where curvature asks for none.
constexpr double kGradedAspect = 2;

/// Normal curvature in the tangent direction `d` of wedge w (Euler's formula).
double normal_curvature(const PrincipalField& field, Index w, const Vec3& d) {
  const double c = field.t_min[w].dot(d);
  const double c2 = std::min(1.0, c * c);
  return field.k_min[w] * c2 + field.k_max[w] * (1 - c2);
}

/// Pairs of spacings that feature lines tie together: the distances *along* the line on its two
/// sides, so that lines that cross it can go on. Keys as in `grade`; sorted, both ways.
std::vector<std::pair<Index, Index>> links_across_features(const TriMesh& mesh,
                                                           const PrincipalField& field) {
  std::vector<std::pair<Index, Index>> links;
  const auto key_along = [&](Index w, const Vec3& edge) {
    const Vec3& n = field.normal[w];
    const Vec3 flat = edge - n * n.dot(edge);
    const double c = field.cross[w].dot(flat);
    return c * c >= 0.5 * flat.squaredNorm() ? w : w + mesh.wedge_count();
  };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_feature[h] == 0) continue;
    const Vec3 edge = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
    const Index here = key_along(mesh.wedge_of(h), edge);
    const Index there = key_along(mesh.wedge_of(TriMesh::next(mesh.twin[h])), edge);
    links.emplace_back(here, there);
    links.emplace_back(there, here);
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

/// Bounds the slope of both spacings by a wave from the smallest values outwards; the arms of
/// neighbouring crosses are matched by direction.
void grade(const TriMesh& mesh, const PrincipalField& field, double slope, Spacing& spacing) {
  const Index n = mesh.wedge_count();
  // Where the surface itself is not anisotropic, neither should grading make the cells so.
  std::vector<double> aspect(n);
  for (Index w = 0; w < n; ++w) {
    const auto [small, large] = std::minmax(spacing.along[w], spacing.across[w]);
    aspect[w] = std::max(kGradedAspect, large / small);
  }
  const auto value = [&](Index key) -> double& {
    return key < n ? spacing.along[key] : spacing.across[key - n];
  };
  std::vector<Index> corner_offsets(n + 1, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) ++corner_offsets[mesh.wedge_of(h) + 1];
  for (Index w = 0; w < n; ++w) corner_offsets[w + 1] += corner_offsets[w];
  std::vector<Index> corners(mesh.halfedge_count());
  std::vector<Index> fill(corner_offsets.begin(), corner_offsets.end() - 1);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) corners[fill[mesh.wedge_of(h)]++] = h;

  const std::vector<std::pair<Index, Index>> links = links_across_features(mesh, field);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto lower = [&](Index target, double reach) {
    if (!(reach < value(target))) return;
    value(target) = reach;
    queue.emplace(reach, target);
  };
  const auto relax_from = [&](Index key) {
    const Index w = key < n ? key : key - n;
    const double here = value(key);
    lower(key < n ? key + n : key - n, aspect[w] * here);
    for (auto link = std::lower_bound(links.begin(), links.end(), std::pair{key, kNone});
         link != links.end() && link->first == key; ++link) {
      lower(link->second, here);
    }
    for (Index at = corner_offsets[w]; at < corner_offsets[w + 1]; ++at) {
      const Index h = corners[at];
      for (const Index other : {TriMesh::next(h), TriMesh::prev(h)}) {
        const Index v = mesh.wedge_of(other);
        const double reach = here + slope * (mesh.positions[mesh.from(other)] -
                                             mesh.positions[mesh.from(h)]).norm();
        const Vec3 arm = rotate_between(field.normal[w], field.normal[v], field.cross[w]);
        const bool same = std::abs(arm.dot(field.cross[v])) >= M_SQRT1_2;
        lower(same == (key < n) ? v : v + n, reach);
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
