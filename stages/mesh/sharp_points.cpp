#include "stages/mesh/sharp_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/frames.h"
#include "common/geometry/nearest_on_surface.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/surface_lines.h"
#include "common/geometry/surface_point.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// Distance of faces at a tip from the surface, as a share of the tip's own from the cell over it:
/// half of it is what edges from a thorn to the flat around it are off.
constexpr double kMostOff = 0.45;
/// How much farther off faces around a moved vertex may be than those around one that is added:
/// that makes no odd faces.
constexpr double kMovedOff = 1.5;
/// A vertex is at a tip up to this share of its longest edge, and moved there however far off faces
/// are, as they are so already.
constexpr double kAtTip = 0.2;

/// Corners that no feature or boundary line comes to.
std::vector<Index> sharp_points(const TriMesh& mesh) {
  std::vector<Index> points;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.is_corner[v] == 0) continue;
    const bool is_on_line = any_outgoing(
        mesh, v, [&](Index h) { return mesh.is_barrier(h) || mesh.is_barrier(TriMesh::prev(h)); });
    if (!is_on_line) points.push_back(v);
  }
  return points;
}

/// Sum of the normals around a vertex.
Vec3 axis_at(const TriMesh& mesh, Index vertex) {
  Vec3 axis = Vec3::Zero();
  for_each_outgoing(mesh, vertex, [&](Index h) { axis += face_cross(mesh, TriMesh::face_of(h)); });
  return axis.normalized();
}

class SharpPoints {
 public:
  SharpPoints(const TriMesh& mesh, bool may_add, QuadMesh& quads)
      : mesh_(mesh),
        surface_(mesh.positions, mesh.faces),
        quads_(quads),
        nearest_(mesh, quads),
        lines_(mesh),
        may_add_(may_add),
        is_changed_(static_cast<std::size_t>(quads.mesh.face_count()), 0) {
    for (Index f = 0; f < quads.mesh.face_count(); ++f) {
      const auto face = quads.mesh.face(f);
      faces_.emplace_back(face.begin(), face.end());
    }
    faces_around_.resize(quads.mesh.positions.size());
    for (Index f = 0; f < quads.mesh.face_count(); ++f) {
      for (const Index v : faces_[f]) faces_around_[v].push_back(f);
    }
  }

  /// \return whether a vertex is at the tip now
  bool meet(Index tip) {
    const Vec3& place = mesh_.positions[tip];
    const Index nearest = nearest_.vertex(TriMesh::face_of(mesh_.vertex_out[tip]), place);
    if (nearest == kNone) return false;
    const Vec3 axis = axis_at(mesh_, tip);
    const Index cell = cell_over(place, axis, nearest);
    std::vector<Index> corners = cell == kNone ? std::vector{nearest} : faces_[cell];
    const Vec3 around = middle(cell == kNone ? neighbours(nearest) : corners);
    const double most = kMostOff * std::abs((place - around).dot(axis));
    const auto distance = [&](Index v) { return (at(v) - place).norm(); };
    std::ranges::sort(corners, {}, [&](Index v) { return std::pair{distance(v), v}; });
    Spokes spokes;
    if (may_add_ && cell != kNone && is_changed_[cell] == 0) {
      spokes = best_spokes(place, faces_[cell]);
    }
    for (const Index v : corners) {
      if (!may_move(v, place)) continue;
      const bool is_there = distance(v) <= kAtTip * longest_edge(v);
      if (!is_there && farthest(v, place) > std::min(most, kMovedOff * spokes.off)) continue;
      put(v, tip);
      return true;
    }
    if (spokes.off > most) return false;
    add(tip, cell, spokes.corners);
    return true;
  }

  /// Faces as they are now.
  void store() const {
    PolyMesh& mesh = quads_.mesh;
    mesh.offsets = {0};
    mesh.corners.clear();
    for (const std::vector<Index>& face : faces_) mesh.add_face(face);
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  /// Corners of a cell to which edges run from a vertex inside.
  struct Spokes {
    std::vector<std::size_t> corners = {};  ///< ascending; one or two sides between them
    double off = kNever;                    ///< how far the faces are off the surface
  };

  [[nodiscard]] Vec3 at(Index v) const { return quads_.mesh.positions[v] - mesh_.origin; }

  [[nodiscard]] Vec3 middle(std::span<const Index> vertices) const {
    Vec3 sum = Vec3::Zero();
    for (const Index v : vertices) sum += at(v);
    return sum / static_cast<double>(vertices.size());
  }

  /// The face near a vertex that goes around a place once, seen along an axis; kNone where none
  /// does.
  [[nodiscard]] Index cell_over(const Vec3& place, const Vec3& axis, Index vertex) const {
    std::set<Index> faces;
    for (const Index f : faces_around_[vertex]) {
      for (const Index v : faces_[f]) {
        faces.insert(faces_around_[v].begin(), faces_around_[v].end());
      }
    }
    const auto goes_around = [&](Index f) {
      double turn = 0;
      for (std::size_t i = 0; i < faces_[f].size(); ++i) {
        const Vec3 a = at(faces_[f][i]) - place;
        const Vec3 b = at(faces_[f][(i + 1) % faces_[f].size()]) - place;
        const Vec3 flat = a - axis.dot(a) * axis;
        turn += std::atan2(axis.dot(a.cross(b)), flat.dot(b));
      }
      return turn > M_PI;
    };
    const auto found = std::ranges::find_if(faces, goes_around);
    return found == faces.end() ? kNone : *found;
  }

  /// Corners of the faces around a vertex that come after it, as they were: faces that are divided
  /// since may have the vertex no more.
  [[nodiscard]] std::vector<Index> neighbours(Index v) const {
    std::vector<Index> result;
    for (const Index f : faces_around_[v]) {
      const std::span<const Index> face = quads_.mesh.face(f);
      const auto i = static_cast<std::size_t>(std::ranges::find(face, v) - face.begin());
      result.push_back(face[(i + 1) % face.size()]);
    }
    return result;
  }

  [[nodiscard]] double longest_edge(Index v) const {
    double longest = 0;
    for (const Index w : neighbours(v)) longest = std::max(longest, (at(w) - at(v)).norm());
    return longest;
  }

  /// How far a polygon is off the surface, in the middles of the edges and triangles it is cut
  /// into.
  [[nodiscard]] double farthest(const std::vector<Vec3>& corners) const {
    std::vector<std::array<Index, 3>> triangles;
    triangulate_face(corners, all_of(corners), triangles);
    double farthest = 0;
    const auto look_at = [&](const Vec3& place) {
      farthest = std::max(farthest, surface_.closest(place).distance);
    };
    for (const auto& [a, b, c] : triangles) {
      look_at((corners[a] + corners[b] + corners[c]) / 3);
      for (const auto& [v, w] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        look_at((corners[v] + corners[w]) / 2);
      }
    }
    return farthest;
  }

  static std::vector<Index> all_of(const std::vector<Vec3>& corners) {
    std::vector<Index> all(corners.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  /// The corners of a face where one of them is elsewhere.
  [[nodiscard]] std::vector<Vec3> with_moved(Index face, Index v, const Vec3& place) const {
    std::vector<Vec3> corners;
    for (const Index w : faces_[face]) corners.push_back(w == v ? place : at(w));
    return corners;
  }

  /// How far faces around a vertex are off the surface if it is moved.
  [[nodiscard]] double farthest(Index v, const Vec3& place) const {
    double result = 0;
    for (const Index f : faces_around_[v]) {
      result = std::max(result, farthest(with_moved(f, v, place)));
    }
    return result;
  }

  /// Whether a vertex is on no line and beside no other tip, and no face would be concave that was
  /// not.
  [[nodiscard]] bool may_move(Index v, const Vec3& place) const {
    if (std::ranges::any_of(faces_around_[v], [&](Index f) { return is_changed_[f] != 0; })) {
      return false;
    }
    if (!lines_.places(foot_of(quads_.provenance, v)).empty()) return false;
    return std::ranges::none_of(faces_around_[v], [&](Index f) {
      const auto is_concave = [](const std::vector<Vec3>& corners) {
        return is_concave_face(corners, all_of(corners));
      };
      return is_concave(with_moved(f, v, place)) && !is_concave(with_moved(f, v, at(v)));
    });
  }

  /// Three or more edges into a cell that lie nearest to the surface; as few as make no face
  /// concave, so that most are quads.
  [[nodiscard]] Spokes best_spokes(const Vec3& place, const std::vector<Index>& cell) const {
    Spokes best;
    for (std::size_t count = std::max<std::size_t>(3, (cell.size() + 1) / 2);
         count <= cell.size() && best.corners.empty(); ++count) {
      best = best_spokes(place, cell, count);
    }
    return best;
  }

  [[nodiscard]] Spokes best_spokes(const Vec3& place, const std::vector<Index>& cell,
                                   std::size_t count) const {
    const std::size_t n = cell.size();
    const std::size_t quads = n - count;
    Spokes best;
    for (std::size_t first = 0; first < n; ++first) {
      Spokes spokes;
      for (std::size_t i = 0; i < count; ++i) {
        spokes.corners.push_back((first + i + std::min(i, quads)) % n);
      }
      std::ranges::sort(spokes.corners);
      spokes.off = farthest(place, cell, spokes.corners);
      if (spokes.off < best.off) best = spokes;
    }
    return best;
  }

  /// How far the faces are off the surface into which a cell is cut; `kNever` where one is concave.
  [[nodiscard]] double farthest(const Vec3& place, const std::vector<Index>& cell,
                                const std::vector<std::size_t>& spokes) const {
    double result = 0;
    for (const std::vector<Index>& face : divided(cell, kNone, spokes)) {
      std::vector<Vec3> corners;
      for (const Index v : face) corners.push_back(v == kNone ? place : at(v));
      if (is_concave_face(corners, all_of(corners))) return kNever;
      result = std::max(result, farthest(corners));
    }
    return result;
  }

  /// The faces that edges from a vertex inside cut a face into.
  static std::vector<std::vector<Index>> divided(const std::vector<Index>& face, Index inside,
                                                 const std::vector<std::size_t>& spokes) {
    std::vector<std::vector<Index>> result;
    for (std::size_t i = 0; i < spokes.size(); ++i) {
      const std::size_t last = spokes[(i + 1) % spokes.size()];
      std::vector<Index> part{inside};
      for (std::size_t at = spokes[i];; at = (at + 1) % face.size()) {
        part.push_back(face[at]);
        if (at == last) break;
      }
      result.push_back(std::move(part));
    }
    return result;
  }

  void put(Index v, Index tip) {
    quads_.mesh.positions[v] = mesh_.positions[tip] + mesh_.origin;
    set_foot(quads_.provenance, v, point_at_vertex(mesh_, tip));
    for (const Index f : faces_around_[v]) is_changed_[f] = 1;
  }

  void add(Index tip, Index cell, const std::vector<std::size_t>& spokes) {
    const Index v = quads_.mesh.vertex_count();
    quads_.mesh.positions.emplace_back();
    add_foot(quads_.provenance, {});
    faces_around_.push_back({cell});
    put(v, tip);
    std::vector<std::vector<Index>> parts = divided(faces_[cell], v, spokes);
    faces_[cell] = std::move(parts.back());
    parts.pop_back();
    for (std::vector<Index>& part : parts) faces_.push_back(std::move(part));
  }

  const TriMesh& mesh_;
  SurfaceDistance surface_;
  QuadMesh& quads_;
  NearestOnSurface nearest_;
  SurfaceLines lines_;
  bool may_add_;
  std::vector<std::vector<Index>> faces_;         ///< as they are now
  std::vector<std::vector<Index>> faces_around_;  ///< [V] as they were
  std::vector<char> is_changed_;                  ///< [F] as they were: 1: beside a tip that is met
};

}  // namespace

Index meet_sharp_points(const TriMesh& mesh, bool may_add, QuadMesh& quads) {
  const std::vector<Index> tips = sharp_points(mesh);
  if (tips.empty()) return 0;
  SharpPoints points(mesh, may_add, quads);
  Index met = 0;
  for (const Index tip : tips) met += points.meet(tip) ? 1 : 0;
  points.store();
  return met;
}

}  // namespace strake
