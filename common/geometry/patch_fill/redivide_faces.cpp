#include "common/geometry/patch_fill/redivide_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "common/geometry/angles.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/quad_division.h"

namespace strake {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostBetween = 3;
/// Farthest that an angle of a quad may be from a right one.
constexpr double kMostFromRightAngle = 78 * kDegree;
/// Least cosine of the turn along either diagonal of a quad.
constexpr double kLeastOfBothEvenness = 0.5;
/// Weight of the squared deviation of a number of edges from four, beside those of angles, rad^2.
constexpr double kDegreePrice = 0.1;

bool is_odd(std::span<const Index> face) { return face.size() == 3 || face.size() == 5; }

/// Neighbouring faces as one polygon.
struct Patch {
  std::vector<Index> faces;
  std::vector<std::array<Index, 2>> inner;  ///< edges, the smaller vertex first
  std::vector<Index> outline;
};

class Search {
 public:
  Search(const PolyMesh& mesh, const std::function<bool(Index, Index)>& may_remove,
         const std::set<std::vector<Index>>& refused)
      : mesh_(mesh),
        may_remove_(may_remove),
        refused_(refused),
        edges_(collect_edges(mesh)),
        opposite_(opposite_sides(edges_)),
        degree_(mesh.positions.size(), 0),
        is_border_(mesh.positions.size(), 0) {
    for (Index e = 0; e < edges_.edge_count(); ++e) {
      for (const Index v : edges_.vertices[e]) {
        ++degree_[v];
        if (edges_.sides_of(e).size() != 2) is_border_[v] = 1;
      }
    }
  }

  std::vector<Redivision> run() {
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      const std::span<const Index> face = mesh_.face(f);
      if (!is_odd(face)) continue;
      go_on({{f}, {}, {face.begin(), face.end()}});
    }
    std::ranges::stable_sort(found_, {}, &Redivision::price);
    std::vector<char> claimed(mesh_.positions.size(), 0);
    std::erase_if(found_, [&](const Redivision& change) {
      const auto is_claimed = [&](Index v) { return claimed[v] != 0; };
      if (std::ranges::any_of(change.outline, is_claimed)) return true;
      for (const Index v : change.outline) claimed[v] = 1;
      return false;
    });
    return std::move(found_);
  }

 private:
  /// Adds the faces beside the last one of a patch.
  void go_on(const Patch& patch) {
    const Index last = patch.faces.back();
    for (Index c = mesh_.offsets[last]; c < mesh_.offsets[last + 1]; ++c) {
      if (opposite_[c] == kNone) continue;
      const Index next = edges_.corner_face[opposite_[c]];
      // A way is found from both of its ends.
      if (std::ranges::find(patch.faces, next) != patch.faces.end()) continue;
      const bool ends = is_odd(mesh_.face(next));
      if (ends ? next < patch.faces.front()
               : mesh_.face(next).size() != 4 || patch.faces.size() > kMostBetween) {
        continue;
      }
      const Index a = mesh_.corners[c];
      const Index b = mesh_.corners[next_corner(mesh_, edges_, c)];
      if (!may_remove_(a, b)) continue;
      Patch longer = patch;
      if (!join(longer, next, a, b)) continue;
      if (ends) {
        divide(longer);
      } else {
        go_on(longer);
      }
    }
  }

  /// Joins the face beyond the side from a to b to a patch.
  /// \return whether it is a disk then, without a vertex inside
  [[nodiscard]] bool join(Patch& patch, Index next, Index a, Index b) const {
    const std::span<const Index> face = mesh_.face(next);
    auto at = std::ranges::find(patch.outline, a);
    if (at == patch.outline.end()) return false;
    if (at + 1 == patch.outline.end()) {
      std::rotate(patch.outline.begin(), patch.outline.begin() + 1, patch.outline.end());
      at = patch.outline.end() - 2;
    }
    if (*(at + 1) != b) return false;
    const auto from = std::ranges::find(face, a);
    std::vector<Index> beyond;
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      beyond.push_back(face[(static_cast<std::size_t>(from - face.begin()) + i) % face.size()]);
      if (std::ranges::find(patch.outline, beyond.back()) != patch.outline.end()) return false;
    }
    patch.outline.insert(at + 1, beyond.begin(), beyond.end());
    patch.faces.push_back(next);
    patch.inner.push_back({std::min(a, b), std::max(a, b)});
    return true;
  }

  void divide(const Patch& patch) {
    std::vector<Index> outline = patch.outline;
    std::rotate(outline.begin(), std::ranges::min_element(outline), outline.end());
    if (refused_.contains(outline)) return;
    std::vector<Index> degree;  // without the edges inside
    for (const Index v : outline) {
      const auto has = [&](const std::array<Index, 2>& edge) {
        return edge[0] == v || edge[1] == v;
      };
      degree.push_back(degree_[v] - static_cast<Index>(std::ranges::count_if(patch.inner, has)));
    }
    const Vec3 normal = newell_normal(mesh_.positions, outline);
    const auto quad = [&](std::size_t i, std::size_t a, std::size_t b, std::size_t j) {
      return shape_price({outline[i], outline[a], outline[b], outline[j]}, normal);
    };
    const auto diagonal = [&](std::size_t i, std::size_t j) {
      const std::array<Index, 2> ends = {std::min(outline[i], outline[j]),
                                         std::max(outline[i], outline[j])};
      if (has_edge(ends) && std::ranges::find(patch.inner, ends) == patch.inner.end()) {
        return kInfinity;
      }
      return degree_price(outline[i], degree[i]) + degree_price(outline[j], degree[j]);
    };
    const auto division = cheapest_division(outline.size(), quad, diagonal);
    if (!division) return;
    for (const auto& [i, j] : division->diagonals) {
      ++degree[i];
      ++degree[j];
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
      if (degree[i] < 3 && is_border_[outline[i]] == 0) return;
    }
    Redivision change;
    for (const auto& [i, a, b, j] : division->quads) {
      change.added.push_back({outline[i], outline[a], outline[b], outline[j]});
      change.price += quad(i, a, b, j);
    }
    change.price /= static_cast<double>(change.added.size());
    change.removed = patch.faces;
    change.outline = std::move(outline);
    found_.push_back(std::move(change));
  }

  [[nodiscard]] bool has_edge(const std::array<Index, 2>& ends) const {
    return std::ranges::binary_search(edges_.vertices, ends);
  }

  /// Of one more edge at a vertex.
  [[nodiscard]] double degree_price(Index v, Index degree) const {
    if (is_border_[v] != 0) return 0;
    return kDegreePrice * ((degree - 3) * (degree - 3) - (degree - 4) * (degree - 4));
  }

  /// Mean squared deviation of the angles from right ones, rad^2; infinite where the quad must not
  /// be.
  [[nodiscard]] double shape_price(const std::array<Index, 4>& face, const Vec3& normal) const {
    if (newell_normal(mesh_.positions, face).dot(normal) <= 0 ||
        is_concave_face(mesh_.positions, face)) {
      return kInfinity;
    }
    std::array<Vec3, 4> turn;  // unit normal of the corner
    double price = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3& p = mesh_.positions[face[i]];
      const Vec3 ahead = mesh_.positions[face[(i + 1) % 4]] - p;
      const Vec3 back = mesh_.positions[face[(i + 3) % 4]] - p;
      const double off = angle_between(ahead, back) - std::numbers::pi / 2;
      if (std::abs(off) > kMostFromRightAngle) return kInfinity;
      turn[i] = ahead.cross(back).normalized();
      price += off * off / 4;
    }
    // The two triangles along a diagonal lie at the corners that are not on it.
    const bool is_even =
        turn[0].dot(turn[2]) > kLeastOfBothEvenness && turn[1].dot(turn[3]) > kLeastOfBothEvenness;
    return is_even ? price : kInfinity;
  }

  const PolyMesh& mesh_;
  const std::function<bool(Index, Index)>& may_remove_;
  const std::set<std::vector<Index>>& refused_;
  PolyEdges edges_;
  std::vector<Index> opposite_;  ///< [C] of `edges_`
  std::vector<Index> degree_;    ///< [V] edges
  std::vector<char> is_border_;  ///< [V]
  std::vector<Redivision> found_;
};

}  // namespace

std::vector<Redivision> find_redivisions(const PolyMesh& mesh,
                                         const std::function<bool(Index, Index)>& may_remove,
                                         const std::set<std::vector<Index>>& refused) {
  return Search(mesh, may_remove, refused).run();
}

PolyMesh redivide_faces(const PolyMesh& mesh, std::span<const Redivision> changes,
                        std::vector<Index>& change_of_face) {
  std::vector<char> is_removed(static_cast<std::size_t>(mesh.face_count()), 0);
  for (const Redivision& change : changes) {
    for (const Index f : change.removed) is_removed[f] = 1;
  }
  PolyMesh result;
  result.positions = mesh.positions;
  change_of_face.clear();
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (is_removed[f] != 0) continue;
    result.add_face(mesh.face(f));
    change_of_face.push_back(kNone);
  }
  for (std::size_t i = 0; i < changes.size(); ++i) {
    for (const std::vector<Index>& face : changes[i].added) {
      result.add_face(face);
      change_of_face.push_back(static_cast<Index>(i));
    }
  }
  return result;
}

}  // namespace strake
