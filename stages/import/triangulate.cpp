#include "stages/import/triangulate.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/mix_bits.h"
#include "common/geometry/angles.h"
#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake::import {
namespace {

/// Height of a triangle over its longest edge divided by that edge; negative where it is turned
/// over against `normal`, 0 without area.
double shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  if (!(longest > 0)) return 0;
  const Vec3 area = (b - a).cross(c - a);
  return std::copysign(area.norm(), area.dot(normal)) / longest;
}

/// The edges that are taken: two quads that share three corners must not get the same diagonal, nor
/// may a diagonal run where there is an edge. Faces with the same corners do not get in each
/// other's way, so that copies stay copies.
class TakenEdges {
 public:
  explicit TakenEdges(const PolyMesh& mesh) {
    slots_.resize(std::bit_ceil(2 * mesh.corners.size() + 16));
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const auto face = mesh.face(f);
      const std::uint64_t owner = key(face);
      for (std::size_t i = 0; i < face.size(); ++i) {
        take(face[i], face[(i + 1) % face.size()], owner);
      }
    }
  }

  void take(Index a, Index b, std::span<const Index> face) { take(a, b, key(face)); }

  [[nodiscard]] bool is_free(Index a, Index b, std::span<const Index> face) const {
    const Slot& slot = slots_[find(key(a, b))];
    return slot.edge == 0 || slot.owner == key(face);
  }

 private:
  struct Slot {
    std::uint64_t edge = 0;
    std::uint64_t owner = 0;
  };

  void take(Index a, Index b, std::uint64_t owner) {
    const std::uint64_t edge = key(a, b);
    Slot& slot = slots_[find(edge)];
    if (slot.edge == 0) slot = {edge, owner};
  }
  static std::uint64_t key(Index a, Index b) {
    const auto [low, high] = std::minmax({a, b});
    return (static_cast<std::uint64_t>(low + 1) << 32) | static_cast<std::uint32_t>(high);
  }
  static std::uint64_t key(std::span<const Index> face) {
    std::uint64_t sum = 0;
    for (const Index v : face) sum += mix_bits(0, static_cast<std::uint64_t>(v) + 1);
    return sum;
  }
  [[nodiscard]] std::size_t find(std::uint64_t edge) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = mix_bits(0, edge) & mask;
    while (slots_[at].edge != 0 && slots_[at].edge != edge) at = (at + 1) & mask;
    return at;
  }

  std::vector<Slot> slots_;
};

/// Triangles of a quad that are flatter than this, or turned over, are avoided.
constexpr double kLeastShape = 0.01;

/// Whether to cut a quad between its corners 0 and 2 rather than 1 and 3: along the shorter
/// diagonal where both will do, as faces of results are measured and drawn.
bool cut_from_first_corner(const std::vector<Vec3>& positions, std::span<const Index> quad,
                           const TakenEdges& taken) {
  const bool first_free = taken.is_free(quad[0], quad[2], quad);
  const bool second_free = taken.is_free(quad[1], quad[3], quad);
  if (first_free != second_free) return first_free;
  const Vec3 normal = newell_normal(positions, quad);
  const auto at = [&](int k) -> const Vec3& { return positions[quad[k % 4]]; };
  const auto worst = [&](int i) {
    return std::min(shape(at(i), at(i + 1), at(i + 2), normal),
                    shape(at(i), at(i + 2), at(i + 3), normal));
  };
  constexpr double kTie = 1e-6;
  const std::array<double, 2> shapes = {worst(0), worst(1)};
  if (std::min(shapes[0], shapes[1]) < kLeastShape) {
    if (std::abs(shapes[0] - shapes[1]) > kTie) return shapes[0] > shapes[1];
  } else {
    const double first = (at(2) - at(0)).squaredNorm();
    const double second = (at(3) - at(1)).squaredNorm();
    if (std::abs(first - second) > kTie * std::max(first, second)) return first < second;
  }
  // The same cut for equal quads that begin elsewhere or are turned over.
  return std::min(quad[0], quad[2]) < std::min(quad[1], quad[3]);
}

/// Twice the area of a triangle; negative where it is clockwise.
double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The reflex corners of a polygon, from which some are taken; where they are many, in a tree.
class ReflexCorners {
 public:
  /// \param points  [n] of all corners of the polygon
  explicit ReflexCorners(const std::vector<Vec2>& points) : points_(points) {}

  void assign(std::vector<int> corners) {
    corners_ = std::move(corners);
    is_there_.assign(points_.size(), 0);
    for (const int corner : corners_) is_there_[corner] = 1;
    rebuild();
  }

  [[nodiscard]] bool contains(int corner) const { return is_there_[corner] != 0; }

  /// \pre contains(corner)
  void remove(int corner) {
    is_there_[corner] = 0;
    if (2 * ++removed_ > corners_.size()) rebuild();
  }

  /// Whether one in or on a triangle is as asked. \pre the triangle is counter-clockwise
  template <typename IsAsked>
  [[nodiscard]] bool any_in(const Vec2& a, const Vec2& b, const Vec2& c,
                            const IsAsked& is_asked) const {
    const auto is_hit = [&](int corner) {
      const Vec2& p = points_[corner];
      return contains(corner) && cross(a, b, p) >= 0 && cross(b, c, p) >= 0 &&
             cross(c, a, p) >= 0 && is_asked(corner);
    };
    if (!tree_) return std::any_of(corners_.begin(), corners_.end(), is_hit);
    BoxTree::Box around;
    for (const Vec2* p : {&a, &b, &c}) around.extend(Vec3(p->x(), p->y(), 0));
    bool found = false;
    tree_->visit_touching_while(around, [&](Index k) {
      found = is_hit(corners_[k]);
      return !found;
    });
    return found;
  }

 private:
  static constexpr std::size_t kLeastForTree = 64;

  void rebuild() {
    std::erase_if(corners_, [&](int corner) { return !contains(corner); });
    removed_ = 0;
    tree_.reset();
    if (corners_.size() < kLeastForTree) return;
    std::vector<BoxTree::Box> places;
    for (const int corner : corners_) {
      places.emplace_back(Vec3(points_[corner].x(), points_[corner].y(), 0));
    }
    tree_.emplace(places);
  }

  const std::vector<Vec2>& points_;
  std::vector<int> corners_;  ///< also some that were removed
  std::vector<std::uint8_t> is_there_;
  std::size_t removed_ = 0;
  std::optional<BoxTree> tree_;  ///< of corners_
};

/// Cuts ears off one polygon, in two dimensions, the one with the largest least angle in space
/// first.
class EarClipper {
 public:
  EarClipper(const std::vector<Vec3>& positions, std::span<const Index> polygon)
      : count_(static_cast<int>(polygon.size())), reflex_(points_) {
    const Vec3 normal = newell_normal(positions, polygon).normalized();
    const Vec3 x = normal.unitOrthogonal();
    const Vec3 y = normal.cross(x);
    const Vec3& base = positions[polygon[0]];
    for (int i = 0; i < count_; ++i) {
      const Vec3 p = positions[polygon[i]] - base;
      places_.push_back(p);
      points_.emplace_back(p.dot(x), p.dot(y));
      next_.push_back((i + 1) % count_);
      previous_.push_back((i + count_ - 1) % count_);
    }
    version_.assign(count_, 0);
    for (int i = 0; i < count_; ++i) push(i);
    std::vector<int> reflex;
    for (int i = 0; i < count_; ++i) {
      if (ear_shape(i) <= 0) reflex.push_back(i);
    }
    reflex_.assign(std::move(reflex));
  }

  /// Calls `emit(a, b, c)` with corner numbers for each triangle.
  template <typename Emit>
  void run(const Emit& emit) {
    int left = count_;
    while (left > 3) {
      const int ear = next_ear();
      emit(previous_[ear], ear, next_[ear]);
      clip(ear);
      --left;
    }
    const int last = *std::find_if(next_.begin(), next_.end(), [](int i) { return i >= 0; });
    emit(previous_[last], last, next_[last]);
  }

 private:
  struct Candidate {
    double angle;  ///< of the ear, the least; -1 where the corner is none
    int corner;
    int version;
    bool operator<(const Candidate& other) const {
      return angle != other.angle ? angle < other.angle : corner > other.corner;
    }
  };

  [[nodiscard]] double ear_shape(int i) const {
    const Vec2& a = points_[previous_[i]];
    const Vec2& b = points_[i];
    const Vec2& c = points_[next_[i]];
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return longest > 0 ? cross(a, b, c) / longest : 0;
  }

  [[nodiscard]] bool is_free(int i) const {
    const Vec2& a = points_[previous_[i]];
    const Vec2& b = points_[i];
    const Vec2& c = points_[next_[i]];
    return !reflex_.any_in(a, b, c, [&](int r) {
      const Vec2& p = points_[r];
      return p != a && p != b && p != c;
    });
  }

  void push(int i) {
    const double angle = ear_shape(i) > 0
                             ? smallest_angle(places_[previous_[i]], places_[i], places_[next_[i]])
                             : -1.0;
    candidates_.push({angle, i, ++version_[i]});
  }

  /// The best ear; where no corner is an ear (the outline crosses itself), the corner that
  /// comes closest to one. Ears found blocked are not looked at again until nothing else is left.
  int next_ear() {
    while (true) {
      while (!candidates_.empty() && candidates_.top().angle >= 0) {
        const Candidate best = candidates_.top();
        candidates_.pop();
        if (next_[best.corner] < 0 || best.version != version_[best.corner]) continue;
        if (is_free(best.corner)) return best.corner;
        blocked_.push_back(best);
      }
      std::erase_if(blocked_, [&](const Candidate& candidate) {
        return next_[candidate.corner] < 0 || candidate.version != version_[candidate.corner];
      });
      if (!clipped_since_retry_) break;
      for (const Candidate& candidate : blocked_) candidates_.push(candidate);
      blocked_.clear();
      clipped_since_retry_ = false;
    }
    return blocked_.empty() ? flattest_corner() : blocked_.front().corner;
  }

  [[nodiscard]] int flattest_corner() const {
    int best = -1;
    double best_shape = 0;
    for (int i = 0; i < count_; ++i) {
      if (next_[i] < 0) continue;
      const double value = std::abs(ear_shape(i));
      if (best < 0 || value < best_shape) best = i;
      if (best == i) best_shape = value;
    }
    return best;
  }

  void clip(int ear) {
    const int before = previous_[ear];
    const int after = next_[ear];
    next_[before] = after;
    previous_[after] = before;
    next_[ear] = -1;
    clipped_since_retry_ = true;
    push(before);
    push(after);
    for (const int i : {ear, before, after}) {  // of no other corner anything has changed
      if (reflex_.contains(i) && (i == ear || ear_shape(i) > 0)) reflex_.remove(i);
    }
  }

  int count_;
  std::vector<Vec3> places_;
  std::vector<Vec2> points_;
  std::vector<int> next_;  ///< -1 once cut off
  std::vector<int> previous_;
  std::vector<int> version_;
  ReflexCorners reflex_;
  std::priority_queue<Candidate> candidates_;
  std::vector<Candidate> blocked_;
  bool clipped_since_retry_ = false;
};

class Triangulator {
 public:
  Triangulator(const PolyMesh& mesh, Repairs& repairs) : mesh_(mesh), repairs_(repairs) {}

  Soup run() {
    soup_.positions = mesh_.positions;
    soup_.source_vertex.resize(mesh_.positions.size());
    for (Index v = 0; v < mesh_.vertex_count(); ++v) soup_.source_vertex[v] = v;
    std::size_t triangles = 0;
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      triangles += std::max<std::size_t>(mesh_.face(f).size(), 2) - 2;
    }
    soup_.faces.reserve(triangles);
    soup_.source_face.reserve(triangles);
    for (Index f = 0; f < mesh_.face_count(); ++f) add_face(f);
    return std::move(soup_);
  }

 private:
  void add_face(Index f) {
    const auto face = mesh_.face(f);
    const bool usable = std::all_of(face.begin(), face.end(), [&](Index v) {
      return v >= 0 && v < mesh_.vertex_count() && mesh_.positions[v].allFinite();
    });
    if (!usable || face.size() < 3) {
      ++repairs_.unusable_faces;
      return;
    }
    polygon_.clear();
    corner_.clear();
    for (std::size_t i = 0; i < face.size(); ++i) {
      // Triangles with a repeated corner are counted as degenerate later on.
      if (face.size() > 3 && face[i] == face[(i + 1) % face.size()]) continue;
      polygon_.push_back(face[i]);
      corner_.push_back(mesh_.offsets[f] + static_cast<Index>(i));
    }
    if (polygon_.size() < 3) {
      ++repairs_.degenerate_faces;
      return;
    }
    if (face.size() > 3) ++repairs_.triangulated_faces;
    add_polygon(f);
  }

  void add_polygon(Index f) {
    const auto& p = polygon_;
    const int sides = static_cast<int>(p.size());
    if (sides == 4) {
      if (!taken_) taken_.emplace(mesh_);
      const bool first = cut_from_first_corner(mesh_.positions, p, *taken_);
      taken_->take(p[first ? 0 : 1], p[first ? 2 : 3], p);
      const int start = first ? 0 : 1;
      add(f, start, start + 1, start + 2);
      add(f, start, start + 2, (start + 3) % 4);
    } else if (sides == 3 || !(newell_normal(mesh_.positions, p).squaredNorm() > 0)) {
      for (int i = 1; i + 1 < sides; ++i) add(f, 0, i, i + 1);
    } else {
      EarClipper(mesh_.positions, p).run([&](int a, int b, int c) { add(f, a, b, c); });
    }
  }

  /// Adds a triangle of three corners of the polygon.
  void add(Index f, int a, int b, int c) {
    soup_.faces.push_back({polygon_[a], polygon_[b], polygon_[c]});
    soup_.source_face.push_back(f);
    const auto& texture = mesh_.attributes.texture;
    if (texture.empty()) return;
    soup_.texture.push_back({texture[corner_[a]], texture[corner_[b]], texture[corner_[c]]});
  }

  const PolyMesh& mesh_;
  Repairs& repairs_;
  Soup soup_;
  std::vector<Index> polygon_;       ///< vertices
  std::vector<Index> corner_;        ///< of the input, for each of `polygon_`
  std::optional<TakenEdges> taken_;  ///< once there is a quad
};

}  // namespace

Soup triangulate(const PolyMesh& mesh, Repairs& repairs) {
  Soup soup = Triangulator(mesh, repairs).run();
  // Half-edges are numbered.
  constexpr std::size_t kMostTriangles = std::numeric_limits<Index>::max() / 3;
  if (soup.faces.size() > kMostTriangles) {
    throw InputError(fmt::format("more than {} triangles, {}; split the model into parts",
                                 kMostTriangles, soup.faces.size()));
  }
  return soup;
}

}  // namespace strake::import
