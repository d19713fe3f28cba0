#include "common/geometry/patch_fill/join_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "common/geometry/angles.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

/// Farthest that an angle of a quad may be from a right one.
constexpr double kFromRightAngle = 70 * kDegree;
/// Least cosine of the turn along its diagonal.
constexpr double kLeastEvenness = 0.7;

using Polygon = std::vector<Index>;

/// How far the worst angle of a polygon is from a right one, radians.
double from_right_angle(const std::vector<Vec3>& positions, const Polygon& polygon) {
  double worst = 0;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = positions[polygon[i]];
    const double angle =
        angle_between(positions[polygon[(i + 1) % n]] - p, positions[polygon[(i + n - 1) % n]] - p);
    worst = std::max(worst, std::abs(angle - std::numbers::pi / 2));
  }
  return worst;
}

struct Joint {
  double from_right_angle;
  std::array<std::size_t, 2> triangles;
  Polygon quad;
};

/// Those that may be, in the order of the triangles.
std::vector<Joint> find_joints(const std::vector<Vec3>& positions,
                               const std::vector<Polygon>& triangles,
                               const std::function<bool(Index, Index)>& may_join) {
  std::map<std::array<Index, 2>, std::size_t> triangle_of_side;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      triangle_of_side[{triangles[t][i], triangles[t][(i + 1) % 3]}] = t;
    }
  }
  const auto normal = [&](std::size_t t) {
    return Vec3(newell_normal(positions, triangles[t]).normalized());
  };
  std::vector<Joint> joints;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = triangles[t][i];
      const Index b = triangles[t][(i + 1) % 3];
      const auto other = triangle_of_side.find({b, a});
      if (other == triangle_of_side.end() || other->second < t || !may_join(a, b)) continue;
      const Polygon& beyond = triangles[other->second];
      const Index apex = *std::ranges::find_if(beyond, [&](Index v) { return v != a && v != b; });
      const Polygon quad = {a, apex, b, triangles[t][(i + 2) % 3]};
      const double worst = from_right_angle(positions, quad);
      if (worst > kFromRightAngle || is_concave_face(positions, quad) ||
          normal(t).dot(normal(other->second)) <= kLeastEvenness) {
        continue;
      }
      joints.push_back({worst, {t, other->second}, quad});
    }
  }
  return joints;
}

}  // namespace

void join_triangles(const std::vector<Vec3>& positions, std::vector<Polygon>& triangles,
                    const std::function<bool(Index, Index)>& may_join) {
  std::vector<Joint> joints = find_joints(positions, triangles, may_join);
  std::ranges::stable_sort(joints, {}, &Joint::from_right_angle);
  for (const Joint& joint : joints) {
    const auto& [first, second] = joint.triangles;
    if (triangles[first].size() != 3 || triangles[second].size() != 3) continue;
    triangles[first] = joint.quad;
    triangles[second].clear();
  }
  std::erase_if(triangles, [](const Polygon& polygon) { return polygon.empty(); });
}

}  // namespace strake
