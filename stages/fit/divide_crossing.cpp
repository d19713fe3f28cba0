#include "stages/fit/divide_crossing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "common/geometry/angles.h"
#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/patch_fill/mendable_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"

namespace strake::fitting {
namespace {

constexpr double kLeastAngle = 1 * kDegree;
/// What passes through more faces does so however it is divided: sheets on top of each other.
constexpr int kMostCrossings = 8;

using Polygon = std::vector<Index>;
using Parts = std::array<Polygon, 2>;

class Division {
 public:
  explicit Division(PolyMesh& mesh)
      : mesh_(mesh),
        edges_(collect_edges(mesh).vertices),
        triangles_(triangulate_faces(mesh)),
        tree_(boxes()),
        parts_(static_cast<std::size_t>(mesh.face_count())) {}

  Index run() {
    Index divided = 0;
    std::vector<int> crossed(parts_.size(), 0);
    const auto pairs = mendable_crossings(mesh_, mesh_.positions);
    for (const auto& pair : pairs) {
      for (const Index f : pair) ++crossed[f];
    }
    for (const auto& pair : pairs) {
      for (const Index f : pair) {
        if (parts_[f].has_value() || crossed[f] > kMostCrossings) continue;
        if (divide(f)) ++divided;
      }
    }
    if (divided > 0) write();
    return divided;
  }

 private:
  [[nodiscard]] std::vector<BoxTree::Box> boxes() const {
    std::vector<BoxTree::Box> boxes;
    for (const auto& [a, b, c] : triangles_.corners) {
      boxes.emplace_back(mesh_.positions[a]);
      boxes.back().extend(mesh_.positions[b]).extend(mesh_.positions[c]);
    }
    return boxes;
  }

  [[nodiscard]] std::array<Vec3, 3> shape(const std::array<Index, 3>& corners) const {
    return {mesh_.positions[corners[0]], mesh_.positions[corners[1]], mesh_.positions[corners[2]]};
  }

  /// The triangles of a face as it is by now.
  [[nodiscard]] std::vector<std::array<Index, 3>> triangles_of(Index f) const {
    std::vector<std::array<Index, 3>> triangles;
    if (!parts_[f].has_value()) {
      triangulate_face(mesh_.positions, mesh_.face(f), triangles);
    } else {
      for (const Polygon& part : *parts_[f]) triangulate_face(mesh_.positions, part, triangles);
    }
    return triangles;
  }

  /// How many other faces these triangles of face f pass through.
  [[nodiscard]] std::size_t crossings(Index f, const std::vector<std::array<Index, 3>>& own) const {
    std::set<Index> near;
    std::size_t count = 0;
    for (const auto& triangle : own) {
      BoxTree::Box box(mesh_.positions[triangle[0]]);
      box.extend(mesh_.positions[triangle[1]]).extend(mesh_.positions[triangle[2]]);
      // The tree holds whole faces: parts reach no farther than their corners.
      tree_.visit_touching(box, [&](Index t) { near.insert(triangles_.face[t]); });
    }
    near.erase(f);
    for (const Index g : near) {
      const auto others = triangles_of(g);
      count += std::any_of(own.begin(), own.end(), [&](const auto& a) {
        return std::any_of(others.begin(), others.end(),
                           [&](const auto& b) { return triangles_cross(shape(a), shape(b)); });
      });
    }
    return count;
  }

  [[nodiscard]] bool is_edge(Index a, Index b) const {
    return std::binary_search(edges_.begin(), edges_.end(),
                              std::array<Index, 2>{std::min(a, b), std::max(a, b)});
  }

  [[nodiscard]] bool is_sound(const Polygon& part, const Vec3& normal) const {
    const std::vector<Vec3>& p = mesh_.positions;
    if (is_concave_face(p, part) || newell_normal(p, part).dot(normal) <= 0) return false;
    const std::size_t n = part.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 ahead = p[part[(i + 1) % n]] - p[part[i]];
      const Vec3 back = p[part[(i + n - 1) % n]] - p[part[i]];
      if (angle_between(ahead, back) < kLeastAngle) return false;
    }
    return true;
  }

  /// Divides a face where that lessens its crossings.
  bool divide(Index f) {
    const Polygon face(mesh_.face(f).begin(), mesh_.face(f).end());
    const Vec3 normal = newell_normal(mesh_.positions, face);
    std::size_t fewest = crossings(f, triangles_of(f));
    std::optional<Parts> best;
    for (std::size_t i = 0; i < face.size(); ++i) {
      for (std::size_t j = i + 2; j < face.size() && j - i < face.size() - 1; ++j) {
        if (is_edge(face[i], face[j])) continue;
        Parts parts;
        for (std::size_t k = 0; k < face.size(); ++k) {
          if (k >= i && k <= j) parts[0].push_back(face[k]);
          if (k <= i || k >= j) parts[1].push_back(face[k]);
        }
        if (!is_sound(parts[0], normal) || !is_sound(parts[1], normal)) continue;
        std::vector<std::array<Index, 3>> own;
        for (const Polygon& part : parts) triangulate_face(mesh_.positions, part, own);
        const std::size_t count = crossings(f, own);
        if (count >= fewest) continue;
        fewest = count;
        best = parts;
      }
    }
    if (!best) return false;
    parts_[f] = best;
    const Polygon& first = best->front();
    const std::array<Index, 2> diagonal = {std::min(first.front(), first.back()),
                                           std::max(first.front(), first.back())};
    edges_.insert(std::lower_bound(edges_.begin(), edges_.end(), diagonal), diagonal);
    return true;
  }

  void write() {
    PolyMesh divided;
    divided.positions = std::move(mesh_.positions);
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      divided.add_face(parts_[f] ? std::span<const Index>(parts_[f]->front()) : mesh_.face(f));
    }
    for (const auto& parts : parts_) {
      if (parts) divided.add_face(parts->back());
    }
    mesh_ = std::move(divided);
  }

  PolyMesh& mesh_;
  std::vector<std::array<Index, 2>> edges_;  ///< ascending
  FaceTriangles triangles_;                  ///< of the undivided faces
  BoxTree tree_;
  std::vector<std::optional<Parts>> parts_;  ///< [F] where divided
};

}  // namespace

Index divide_crossing_faces(PolyMesh& mesh) { return Division(mesh).run(); }

}  // namespace strake::fitting
