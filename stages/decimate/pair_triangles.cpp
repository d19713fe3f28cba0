#include "stages/decimate/pair_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <vector>

#include "common/geometry/angles.h"
#include "common/geometry/patch_fill/redivide_faces.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

/// Farthest that an angle of a quad may be from a right one.
constexpr double kFromRightAngle = 82 * kDegree;
/// Most that a quad turns along the diagonal between its triangles.
constexpr double kMostTurn = 50 * kDegree;
/// Where the other diagonal is the shorter one, and so that with which others draw the quad: most
/// that the two are apart, in shares of the shorter.
constexpr double kMostApart = 0.03;
/// Triangles that are looked at for the partner of one, so that the cost stays linear.
constexpr std::size_t kMostVisited = 1000;

/// Most that corners of a flat polygon are off its plane, in shares of the farthest one's distance
/// from the middle.
constexpr double kFlat = 0.01;

/// A pair of triangles that may become a quad.
struct Joint {
  double from_right_angle = 0;  ///< of the worst corner, radians
  std::array<Index, 2> triangles = {kNone, kNone};
  std::array<Index, 4> quad = {};
};

/// Distance of the middles of the diagonals, along the quad's normal.
double diagonals_apart(const std::array<Vec3, 4>& p) {
  const Vec3 normal = (p[2] - p[0]).cross(p[3] - p[1]);
  const double length = normal.norm();
  return length > 0 ? std::abs((p[0] + p[2] - p[1] - p[3]).dot(normal)) / (2 * length) : 0;
}

/// The quad over an edge, if it may be. \param quad  the edge joins its corners 0 and 2
std::optional<double> from_right_angle(const std::vector<Vec3>& positions,
                                       const std::array<Index, 4>& quad) {
  std::array<Vec3, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = positions[quad[i]];
  const Vec3 first = (p[1] - p[0]).cross(p[2] - p[0]);
  const Vec3 second = (p[2] - p[0]).cross(p[3] - p[0]);
  if (angle_between(first, second) > kMostTurn || is_concave_face(positions, quad)) return {};
  const double kept = (p[2] - p[0]).norm();
  const double other = (p[3] - p[1]).norm();
  if (other < kept && diagonals_apart(p) > kMostApart * other) return {};
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double angle = angle_between(p[(i + 1) % 4] - p[i], p[(i + 3) % 4] - p[i]);
    worst = std::max(worst, std::abs(angle - std::numbers::pi / 2));
  }
  if (worst > kFromRightAngle) return {};
  return worst;
}

class Pairing {
 public:
  explicit Pairing(const CoarseSurface& surface)
      : surface_(surface),
        joints_at_(surface.faces.size()),
        joint_of_(surface.faces.size(), kNone) {
    find_joints();
  }

  /// Takes the best first.
  void take_best() {
    std::vector<Index> order(joints_.size());
    for (std::size_t j = 0; j < order.size(); ++j) order[j] = static_cast<Index>(j);
    std::ranges::stable_sort(order, {}, [&](Index j) { return joints_[j].from_right_angle; });
    for (const Index j : order) {
      const auto& [first, second] = joints_[j].triangles;
      if (joint_of_[first] == kNone && joint_of_[second] == kNone) take(j);
    }
  }

  /// Divides pairs anew along alternating ways (Berge 1957) until none is left that would help; but
  /// for ways that meet themselves, which are not followed.
  void divide_anew() {
    for (Index t = 0; t < static_cast<Index>(joint_of_.size()); ++t) {
      if (joint_of_[t] == kNone) find_partner(t);
    }
  }

  [[nodiscard]] PolyMesh faces() const {
    PolyMesh mesh;
    for (Index t = 0; t < static_cast<Index>(joint_of_.size()); ++t) {
      if (joint_of_[t] == kNone) {
        mesh.add_face(surface_.faces[t]);
      } else if (joints_[joint_of_[t]].triangles[0] == t) {
        mesh.add_face(joints_[joint_of_[t]].quad);
      }
    }
    return mesh;
  }

 private:
  void find_joints() {
    std::map<std::array<Index, 2>, Index> side_at;
    for (std::size_t h = 0; h < 3 * surface_.faces.size(); ++h) {
      const auto& face = surface_.faces[h / 3];
      side_at[{face[h % 3], face[(h + 1) % 3]}] = static_cast<Index>(h);
    }
    for (const auto& [side, h] : side_at) {
      const auto twin = side_at.find({side[1], side[0]});
      if (twin == side_at.end() || twin->second < h || surface_.is_barrier[h] != 0) continue;
      const Index g = twin->second;
      const std::array<Index, 4> quad = {side[0], surface_.faces[g / 3][(g + 2) % 3], side[1],
                                         surface_.faces[h / 3][(h + 2) % 3]};
      const std::optional<double> worst = from_right_angle(surface_.positions, quad);
      if (!worst) continue;
      for (const Index t : {h / 3, g / 3})
        joints_at_[t].push_back(static_cast<Index>(joints_.size()));
      joints_.push_back({*worst, {h / 3, g / 3}, quad});
    }
  }

  void take(Index joint) {
    for (const Index t : joints_[joint].triangles) joint_of_[t] = joint;
  }
  [[nodiscard]] Index partner(Index joint, Index triangle) const {
    const auto& [first, second] = joints_[joint].triangles;
    return first == triangle ? second : first;
  }

  /// The shortest way from a triangle without partner to another one, by joints that are not and
  /// are taken in turn.
  void find_partner(Index start) {
    std::map<Index, Index> came_by;  // joint not taken that leads to a triangle
    std::map<Index, Index> came_from;
    std::deque<Index> waiting = {start};
    came_from[start] = kNone;
    while (!waiting.empty() && came_from.size() < kMostVisited) {
      const Index t = waiting.front();
      waiting.pop_front();
      for (const Index joint : joints_at_[t]) {
        const Index next = partner(joint, t);
        if (joint == joint_of_[t] || came_by.contains(next) || came_from.contains(next)) continue;
        came_by[next] = joint;
        if (joint_of_[next] == kNone) {
          exchange(next, came_by, came_from);
          return;
        }
        const Index beyond = partner(joint_of_[next], next);
        if (came_from.contains(beyond) || came_by.contains(beyond)) {
          came_by.erase(next);
          continue;
        }
        came_from[beyond] = t;
        waiting.push_back(beyond);
      }
    }
  }

  /// Takes the joints of the way that ends at a triangle, in place of those taken.
  void exchange(Index end, const std::map<Index, Index>& came_by,
                const std::map<Index, Index>& came_from) {
    Index at = end;
    while (true) {
      const Index joint = came_by.at(at);
      const Index before = partner(joint, at);
      const Index freed = joint_of_[before] == kNone ? kNone : partner(joint_of_[before], before);
      take(joint);
      if (came_from.at(before) == kNone) return;
      at = freed;
    }
  }

  const CoarseSurface& surface_;
  std::vector<Joint> joints_;
  std::vector<std::vector<Index>> joints_at_;  ///< [F]
  std::vector<Index> joint_of_;                ///< [F] the one taken; kNone: a triangle is left
};

bool is_flat(const std::vector<Vec3>& positions, const std::vector<Index>& outline) {
  const Vec3 normal = newell_normal(positions, outline).normalized();
  Vec3 middle = Vec3::Zero();
  for (const Index v : outline) middle += positions[v] / static_cast<double>(outline.size());
  double off = 0;
  double away = 0;
  for (const Index v : outline) {
    off = std::max(off, std::abs((positions[v] - middle).dot(normal)));
    away = std::max(away, (positions[v] - middle).norm());
  }
  return off <= kFlat * away;
}

/// Makes quads of what is left of the triangles in flats by other diagonals than theirs.
void divide_flats_anew(const CoarseSurface& surface, PolyMesh& mesh) {
  std::set<std::array<Index, 2>> barriers;
  for (std::size_t h = 0; h < surface.is_barrier.size(); ++h) {
    const auto& face = surface.faces[h / 3];
    if (surface.is_barrier[h] != 0) barriers.insert({face[h % 3], face[(h + 1) % 3]});
  }
  const auto may_remove = [&](Index a, Index b) {
    return !barriers.contains({a, b}) && !barriers.contains({b, a});
  };
  std::set<std::vector<Index>> refused;
  for (;;) {
    std::vector<Redivision> changes = find_redivisions(mesh, may_remove, refused);
    if (changes.empty()) return;
    std::erase_if(changes, [&](const Redivision& change) {
      return !is_flat(mesh.positions, change.outline) && refused.insert(change.outline).second;
    });
    std::vector<Index> change_of_face;
    mesh = redivide_faces(mesh, changes, change_of_face);
  }
}

}  // namespace

PolyMesh pair_triangles(const CoarseSurface& surface) {
  Pairing pairing(surface);
  pairing.take_best();
  pairing.divide_anew();
  PolyMesh faces = pairing.faces();
  faces.positions = surface.positions;
  divide_flats_anew(surface, faces);
  return faces;
}

}  // namespace strake
