#include "common/geometry/patch_fill/refill_crossing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/face_crossings/placed_face.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/patch_fill/drop_unused_vertices.h"
#include "common/geometry/patch_fill/fill_polygon.h"
#include "common/geometry/patch_fill/join_triangles.h"
#include "common/geometry/patch_fill/mendable_crossings.h"
#include "common/geometry/patch_fill/patch_outline.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/vertex_faces.h"
#include "common/geometry/surface_lines.h"

namespace strake {
namespace {

constexpr int kMostRings = 2;
constexpr std::size_t kMostSides = 48;  ///< of an outline; filling it costs their third power
/// Times that a patch which touches itself in a vertex takes in all around that.
constexpr int kMostClosings = 3;
constexpr int kMostRounds = 4;
/// Samples of a triangle for each of its sides, less one.
constexpr int kSampleSteps = 4;

using Polygon = std::vector<Index>;
using Triangle = std::array<Index, 3>;
using Side = std::pair<Index, Index>;  ///< from one vertex to another

/// What of the surface's feature and boundary lines may not be lost in a patch. The next is tried
/// where faces still cross.
enum class Kept : std::uint8_t { lines, corners, nothing };
constexpr std::array kAllKept = {Kept::lines, Kept::corners, Kept::nothing};

/// Faces in place of others.
struct Filling {
  std::vector<Index> removed;
  std::vector<Polygon> added;
  std::size_t crossings = 0;  ///< pairs in which the added ones are
};

class Refilling {
 public:
  Refilling(const TriMesh& mesh, const SurfaceDistance& surface, QuadMesh& quads, double reach,
            const std::vector<Vec3>& spared)
      : surface_(surface),
        quads_(quads),
        reach_(reach),
        spared_(spared),
        lines_(mesh),
        face_normals_(mesh),
        positions_(quads.mesh.positions),
        pairs_(mendable_crossings(quads.mesh, quads.mesh.positions)) {
    for (Vec3& p : positions_) p -= mesh.origin;
  }

  /// \return faces taken out
  Index run() {
    if (pairs_.empty()) return 0;
    note_neighbours();
    Index count = 0;
    for (const std::vector<Index>& cluster : clusters()) {
      const std::optional<Filling> filling = fewest_crossings(cluster);
      if (!filling) continue;
      count += static_cast<Index>(filling->removed.size());
      take(*filling);
    }
    if (count > 0) write();
    return count;
  }

 private:
  [[nodiscard]] std::span<const Index> face(Index f) const { return quads_.mesh.face(f); }

  void note_neighbours() {
    around_.emplace(quads_.mesh);
    is_touched_.assign(positions_.size(), 0);
    is_removed_.assign(static_cast<std::size_t>(quads_.mesh.face_count()), 0);
    std::vector<BoxTree::Box> boxes;
    for (Index f = 0; f < quads_.mesh.face_count(); ++f) boxes.push_back(box_of(face(f)));
    tree_.emplace(std::move(boxes));
  }

  /// Faces that cross each other, one by one; in a fixed order.
  [[nodiscard]] std::vector<std::vector<Index>> clusters() const {
    std::map<Index, std::vector<Index>> crossed;
    for (const auto& [f, g] : pairs_) {
      crossed[f].push_back(g);
      crossed[g].push_back(f);
    }
    std::vector<std::vector<Index>> clusters;
    std::set<Index> seen;
    for (const auto& entry : crossed) {
      if (!seen.insert(entry.first).second) continue;
      std::vector<Index> cluster = {entry.first};
      for (std::size_t i = 0; i < cluster.size(); ++i) {
        for (const Index g : crossed.at(cluster[i])) {
          if (seen.insert(g).second) cluster.push_back(g);
        }
      }
      clusters.push_back(std::move(cluster));
    }
    return clusters;
  }

  /// The first filling after which nothing crosses, or else the one that leaves the fewest pairs.
  [[nodiscard]] std::optional<Filling> fewest_crossings(const std::vector<Index>& cluster) const {
    std::optional<Filling> best;
    for (const Kept kept : kAllKept) {
      for (int rings = 0; rings <= kMostRings; ++rings) {
        std::optional<Filling> filling = refilled(cluster, rings, kept);
        if (!filling || filling->crossings >= crossings_of(filling->removed)) continue;
        if (!best || filling->crossings < best->crossings) best = std::move(filling);
        if (best->crossings == 0) return best;
      }
    }
    return best;
  }

  /// Pairs in which one of these faces crosses another.
  [[nodiscard]] std::size_t crossings_of(const std::vector<Index>& faces) const {
    const auto is_one = [&](Index f) { return std::ranges::binary_search(faces, f); };
    return static_cast<std::size_t>(
        std::ranges::count_if(pairs_, [&](const auto& p) { return is_one(p[0]) || is_one(p[1]); }));
  }

  /// Faces around a cluster made anew; nothing where that cannot be.
  [[nodiscard]] std::optional<Filling> refilled(const std::vector<Index>& cluster, int rings,
                                                Kept kept) const {
    std::set<Index> patch(cluster.begin(), cluster.end());
    const auto add_around = [&](Index v) {
      const std::span<const Index> faces = around_->faces(v);
      patch.insert(faces.begin(), faces.end());
    };
    for (int ring = 0; ring < rings; ++ring) {
      for (const Index f : std::vector<Index>(patch.begin(), patch.end())) {
        for (const Index v : face(f)) add_around(v);
      }
    }
    for (int i = 0; i <= kMostClosings; ++i) {
      std::vector<Index> pinched;
      Filling filling;
      if (fill(patch, cluster, kept, filling, pinched)) {
        if (!finish(filling)) return std::nullopt;
        return filling;
      }
      if (pinched.empty()) break;
      for (const Index v : pinched) add_around(v);
    }
    return std::nullopt;
  }

  /// The parts of a patch between feature lines that hold faces of the cluster.
  [[nodiscard]] std::vector<std::vector<Index>> parts(const std::set<Index>& patch,
                                                      const std::vector<Index>& cluster,
                                                      Kept kept) const {
    std::vector<std::vector<Index>> parts;
    std::set<Index> seen;
    for (const Index start : cluster) {
      if (!seen.insert(start).second) continue;
      std::vector<Index> part = {start};
      for (std::size_t i = 0; i < part.size(); ++i) {
        for_sides(part[i], [&](Index a, Index b) {
          const Index g = neighbour(a, b);
          if (g == kNone || !patch.contains(g) || is_wall(a, b, kept)) return;
          if (seen.insert(g).second) part.push_back(g);
        });
      }
      std::ranges::sort(part);
      parts.push_back(std::move(part));
    }
    return parts;
  }

  template <class Visit>
  void for_sides(Index f, const Visit& visit) const {
    const std::span<const Index> corners = face(f);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      visit(corners[i], corners[(i + 1) % corners.size()]);
    }
  }
  /// The face beyond the side from a to b; kNone at a boundary.
  [[nodiscard]] Index neighbour(Index a, Index b) const { return around_->face_with_side(b, a); }
  [[nodiscard]] SurfacePoint foot(Index v) const { return foot_of(quads_.provenance, v); }
  /// Whether an edge runs along a feature or boundary line.
  [[nodiscard]] bool is_on_line(Index a, Index b) const {
    return lines_.has_along(foot(a), foot(b));
  }

  [[nodiscard]] bool is_wall(Index a, Index b, Kept kept) const {
    return kept == Kept::lines && is_on_line(a, b);
  }
  [[nodiscard]] bool may_be_lost(Index v, Kept kept) const {
    return kept == Kept::nothing ||
           (kept == Kept::corners ? !lines_.is_corner(foot(v)) : lines_.places(foot(v)).empty());
  }

  /// Fills what is left where the patch is taken out.
  /// \param pinched  gets vertices in which an outline touches itself
  /// \return whether it could be
  bool fill(const std::set<Index>& patch, const std::vector<Index>& cluster, Kept kept,
            Filling& filling, std::vector<Index>& pinched) const {
    std::vector<std::pair<std::vector<Index>, Polygon>> outlines;
    for (std::vector<Index>& part : parts(patch, cluster, kept)) {
      Polygon outline = outline_of(part, kept, pinched);
      if (outline.empty() && pinched.empty()) return false;
      filling.removed.insert(filling.removed.end(), part.begin(), part.end());
      outlines.emplace_back(std::move(part), std::move(outline));
    }
    if (!pinched.empty()) return false;
    std::ranges::sort(filling.removed);
    std::set<Side> edges;  // that were added
    return std::ranges::all_of(outlines, [&](const auto& outline) {
      return fill_outline(outline.first, outline.second, kept, edges, filling);
    });
  }

  /// The vertices around a part, counter-clockwise; empty where it is no disk, or may not go.
  Polygon outline_of(const std::vector<Index>& part, Kept kept, std::vector<Index>& pinched) const {
    std::vector<Polygon> faces;
    for (const Index f : part) faces.emplace_back(face(f).begin(), face(f).end());
    PatchOutline outline =
        patch_outline(faces, [&](Index a, Index b) { return is_wall(a, b, kept); });
    pinched.insert(pinched.end(), outline.pinched.begin(), outline.pinched.end());
    if (!outline.is_disk()) return {};
    Polygon& ring = outline.paths.front().vertices;
    if (ring.size() > kMostSides || is_around_one_face(ring)) return {};
    const std::set<Index> around(ring.begin(), ring.end());
    const auto may_go = [&](Index v) {
      return is_touched_[v] == 0 && (around.contains(v) || may_be_lost(v, kept));
    };
    const bool all_may_go = std::ranges::all_of(
        faces, [&](const Polygon& polygon) { return std::ranges::all_of(polygon, may_go); });
    return all_may_go ? std::move(ring) : Polygon{};
  }

  /// Whether all that is beyond an outline is one face: a filling would lie on its back.
  [[nodiscard]] bool is_around_one_face(const Polygon& outline) const {
    const Index beyond = neighbour(outline[0], outline[1]);
    for (std::size_t i = 1; i < outline.size(); ++i) {
      if (neighbour(outline[i], outline[(i + 1) % outline.size()]) != beyond) return false;
    }
    return beyond != kNone;
  }

  bool fill_outline(const std::vector<Index>& part, const Polygon& outline, Kept kept,
                    std::set<Side>& edges, Filling& filling) const {
    const std::size_t n = outline.size();
    std::vector<Vec3> corners;
    std::vector<Vec3> beyond(n, Vec3::Zero());
    for (std::size_t i = 0; i < n; ++i) {
      corners.push_back(positions_[outline[i]]);
      const Index b = outline[(i + 1) % n];
      const Index g = neighbour(outline[i], b);
      if (g == kNone || is_wall(outline[i], b, kept)) continue;
      beyond[i] = newell_normal(positions_, face(g)).normalized();
    }
    const auto may_join = [&](std::size_t i, std::size_t j) {
      const auto is_taken = [&](Index a, Index b) {
        const Index f = around_->face_with_side(a, b);
        return (f != kNone && !std::ranges::binary_search(part, f)) || edges.contains({a, b});
      };
      return !is_taken(outline[i], outline[j]) && !is_taken(outline[j], outline[i]);
    };
    const auto triangles = fill_polygon(corners, beyond, may_join);
    if (triangles.empty()) return false;
    for (const auto& [a, b, c] : triangles) {
      const Polygon& added =
          filling.added.emplace_back(Polygon{outline[a], outline[b], outline[c]});
      for (std::size_t i = 0; i < 3; ++i) edges.emplace(added[i], added[(i + 1) % 3]);
    }
    return true;
  }

  /// Joins triangles to quads where that does no harm. \return whether the filling may be taken
  bool finish(Filling& filling) const {
    filling.crossings = crossings(filling);
    if (!is_sound(filling)) return false;
    Filling joined = filling;
    join_triangles(positions_, joined.added, [&](Index a, Index b) { return !is_on_line(a, b); });
    joined.crossings = crossings(joined);
    if (joined.crossings <= filling.crossings && is_sound(joined)) filling = std::move(joined);
    return true;
  }

  /// Whether no more faces look inside than before, and all are near enough.
  [[nodiscard]] bool is_sound(const Filling& filling) const {
    const auto looks_inside = [&](std::span<const Index> polygon) {
      Vec3 outward = Vec3::Zero();
      for (const Index v : polygon) {
        if (lines_.places(foot(v)).empty()) outward += face_normals_[foot(v).face];
      }
      return newell_normal(positions_, polygon).dot(outward) < 0;
    };
    const auto before =
        std::ranges::count_if(filling.removed, [&](Index f) { return looks_inside(face(f)); });
    return std::ranges::count_if(filling.added, looks_inside) <= before && !is_spared(filling) &&
           is_near(filling);
  }

  [[nodiscard]] bool is_spared(const Filling& filling) const {
    BoxTree::Box around;
    for (const Index f : filling.removed) around.extend(box_of(face(f)));
    const double far = reach_ * reach_;
    return std::ranges::any_of(
        spared_, [&](const Vec3& p) { return around.squaredExteriorDistance(p) <= far; });
  }

  [[nodiscard]] bool is_near(const Filling& filling) const {
    std::vector<Triangle> added;
    for (const Polygon& polygon : filling.added) triangulate_face(positions_, polygon, added);
    std::vector<Triangle> removed;
    for (const Index f : filling.removed) triangulate_face(positions_, face(f), removed);
    const auto is_near_added = [&](const Vec3& p) {
      return std::ranges::any_of(added, [&](const Triangle& t) {
        return closest_point_on_triangle(p, positions_[t[0]], positions_[t[1]], positions_[t[2]])
                   .distance <= reach_;
      });
    };
    const auto is_near_surface = [&](const Vec3& p) {
      return surface_.closest_within(p, reach_).triangle != kNone;
    };
    return std::ranges::all_of(
               added, [&](const Triangle& t) { return all_samples(t, is_near_surface); }) &&
           std::ranges::all_of(removed,
                               [&](const Triangle& t) { return all_samples(t, is_near_added); });
  }

  template <class Test>
  [[nodiscard]] bool all_samples(const Triangle& triangle, const Test& test) const {
    for (int i = 0; i <= kSampleSteps; ++i) {
      for (int j = 0; i + j <= kSampleSteps; ++j) {
        const double u = static_cast<double>(i) / kSampleSteps;
        const double v = static_cast<double>(j) / kSampleSteps;
        if (!test(Vec3(u * positions_[triangle[0]] + v * positions_[triangle[1]] +
                       (1 - u - v) * positions_[triangle[2]]))) {
          return false;
        }
      }
    }
    return true;
  }

  [[nodiscard]] BoxTree::Box box_of(std::span<const Index> polygon) const {
    BoxTree::Box box;
    for (const Index v : polygon) box.extend(positions_[v]);
    return box;
  }

  /// Pairs of faces that cross once these are in place, of which one is new.
  [[nodiscard]] std::size_t crossings(const Filling& filling) const {
    std::vector<PlacedFace> own;
    BoxTree::Box around;
    for (const Polygon& polygon : filling.added) {
      own.push_back(placed_face(positions_, polygon));
      around.extend(own.back().box);
    }
    std::size_t count = 0;
    const auto count_with = [&](std::span<const Index> polygon) {
      const PlacedFace other = placed_face(positions_, polygon);
      count += static_cast<std::size_t>(std::ranges::count_if(
          own, [&](const PlacedFace& face) { return faces_cross(face, other); }));
    };
    tree_->visit_touching(around, [&](Index f) {
      if (is_removed_[f] == 0 && !std::ranges::binary_search(filling.removed, f)) {
        count_with(face(f));
      }
    });
    for (const Polygon& polygon : added_) count_with(polygon);
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) count += faces_cross(own[i], own[j]) ? 1 : 0;
    }
    return count;
  }

  void take(const Filling& filling) {
    for (const Index f : filling.removed) {
      is_removed_[f] = 1;
      for (const Index v : face(f)) is_touched_[v] = 1;
    }
    added_.insert(added_.end(), filling.added.begin(), filling.added.end());
  }

  void write() {
    PolyMesh refilled;
    for (Index f = 0; f < quads_.mesh.face_count(); ++f) {
      if (is_removed_[f] == 0) refilled.add_face(face(f));
    }
    for (const Polygon& polygon : added_) refilled.add_face(polygon);
    refilled.positions = std::move(quads_.mesh.positions);
    quads_.mesh = std::move(refilled);
    drop_unused_vertices(quads_);
  }

  const SurfaceDistance& surface_;
  QuadMesh& quads_;
  double reach_;
  const std::vector<Vec3>& spared_;
  SurfaceLines lines_;
  FaceNormals face_normals_;
  std::vector<Vec3> positions_;  ///< relative to the mesh's origin
  std::vector<std::array<Index, 2>> pairs_;
  std::optional<VertexFaces> around_;     ///< of the faces at the start
  std::optional<BoxTree> tree_;           ///< of the faces at the start
  std::vector<std::uint8_t> is_touched_;  ///< [V] 1: of a face taken out
  std::vector<std::uint8_t> is_removed_;  ///< [F]
  std::vector<Polygon> added_;
};

}  // namespace

Index refill_crossing_faces(const TriMesh& mesh, const SurfaceDistance& surface, QuadMesh& quads,
                            double reach, const std::vector<Vec3>& spared) {
  Index count = 0;
  // Patches that touch each other are filled one round after the other.
  for (int round = 0; round < kMostRounds; ++round) {
    const Index more = Refilling(mesh, surface, quads, reach, spared).run();
    if (more == 0) break;
    count += more;
  }
  return count;
}

}  // namespace strake
