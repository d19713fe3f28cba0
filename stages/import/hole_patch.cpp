#include "stages/import/hole_patch.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/geometry/angles.h"
#include "common/geometry/patch_fill/fill_polygon.h"

namespace strake::import {
namespace {

/// Corners that are filled at once, which costs their third power; more are parted by a chord.
constexpr std::size_t kMostAtOnce = 150;
/// A chord leaves at least this share of the corners on either side.
constexpr std::size_t kLeastPart = 4;
/// Vertices that are put into a patch at most, and rounds of dividing its triangles.
constexpr std::size_t kMostInside = 100000;
constexpr int kMostDivisions = 40;
constexpr int kMostRelaxations = 20;
/// Angles opposite to an edge that is turned are more than half a turn together, by more than this.
constexpr double kRelaxed = 1e-6;
/// What a face without area has less than.
constexpr double kLeastAngle = 0.01 * kDegree;

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Surface = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Corners = std::vector<std::size_t>;
using MayJoin = std::function<bool(std::size_t, std::size_t)>;

OpenMesh::Vec3d to_openmesh(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
Vec3 from_openmesh(const OpenMesh::Vec3d& p) { return {p[0], p[1], p[2]}; }

/// A part of an outline; its sides may be chords of that.
struct Part {
  Corners corners;
  std::vector<Vec3> beyond;  ///< as in HoleOutline; zero of chords
};

/// From one corner of a part to another one, with the chord from there back.
Part cut_off(const Part& part, std::size_t from, std::size_t to) {
  Part result;
  for (std::size_t i = from;; i = (i + 1) % part.corners.size()) {
    result.corners.push_back(part.corners[i]);
    result.beyond.push_back(i == to ? Vec3::Zero() : part.beyond[i]);
    if (i == to) return result;
  }
}

/// Appends triangles of corners that fill a part. \return whether there are any
bool fill(const HoleOutline& outline, const MayJoin& may_join, const Part& part,
          std::vector<Triangle>& faces) {
  const std::size_t n = part.corners.size();
  const auto place = [&](std::size_t i) { return outline.places[part.corners[i]]; };
  const auto may_join_here = [&](std::size_t i, std::size_t j) {
    return may_join(part.corners[i], part.corners[j]);
  };
  if (n <= kMostAtOnce) {
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < n; ++i) places.push_back(place(i));
    const auto triangles = fill_polygon(places, part.beyond, may_join_here);
    for (const auto& [a, b, c] : triangles) {
      faces.push_back({static_cast<Index>(part.corners[a]), static_cast<Index>(part.corners[b]),
                       static_cast<Index>(part.corners[c])});
    }
    return !triangles.empty();
  }
  double shortest = std::numeric_limits<double>::infinity();
  std::pair<std::size_t, std::size_t> chord;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + n / kLeastPart; j < std::min(n, i + n - n / kLeastPart); ++j) {
      const double length2 = (place(i) - place(j)).squaredNorm();
      if (length2 >= shortest || !may_join_here(i, j)) continue;
      shortest = length2;
      chord = {i, j};
    }
  }
  const auto& [i, j] = chord;
  return shortest < std::numeric_limits<double>::infinity() &&
         fill(outline, may_join, cut_off(part, i, j), faces) &&
         fill(outline, may_join, cut_off(part, j, i), faces);
}

/// A patch that is being divided and faired. Its first vertices are those of the outline.
class Patch {
 public:
  Patch(const HoleOutline& outline, const MayJoin& may_join)
      : outline_(outline), may_join_(may_join) {}

  /// \return whether the faces hang together as those of a surface do
  bool add(const std::vector<Triangle>& faces) {
    const std::size_t n = outline_.places.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3& here = outline_.places[i];
      surface_.add_vertex(to_openmesh(here));
      sizes_.push_back(((here - outline_.places[(i + 1) % n]).norm() +
                        (here - outline_.places[(i + n - 1) % n]).norm()) /
                       2);
    }
    return std::ranges::all_of(faces, [&](const Triangle& face) {
      return surface_.add_face(vertex(face[0]), vertex(face[1]), vertex(face[2])).is_valid();
    });
  }

  /// Divides triangles that are large against the edges of the outline near them.
  void divide() {
    for (int round = 0; round < kMostDivisions && sizes_.size() < kMostInside; ++round) {
      const std::size_t before = sizes_.size();
      const auto faces = static_cast<int>(surface_.n_faces());
      for (int f = 0; f < faces; ++f) divide_face(OpenMesh::FaceHandle(f));
      relax();
      if (sizes_.size() == before) return;
    }
  }

  /// Turns edges until triangles are those of Delaunay, as nearly as their shape allows.
  void relax() {
    for (int round = 0; round < kMostRelaxations; ++round) {
      bool is_done = true;
      for (const auto edge : surface_.edges()) {
        if (!should_turn(edge)) continue;
        surface_.flip(edge);
        is_done = false;
      }
      if (is_done) return;
    }
  }

  /// Puts the vertices inside where the patch goes on smoothly from the surface around; where that
  /// has no solution they stay.
  void fair() {
    const auto n = static_cast<Index>(outline_.places.size());
    const auto all = static_cast<Index>(surface_.n_vertices());
    if (all == n) return;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(all, 3);
    const auto add = [&](Index row, Index v, double weight) {
      if (v >= n) {
        entries.emplace_back(row, v - n, weight);
      } else {
        right.row(row) -= weight * outline_.places[v].transpose();
      }
    };
    for (Index v = 0; v < all; ++v) {
      const std::vector<Index> neighbours = neighbours_of(v);
      const std::size_t beyond = v < n ? outline_.around[v].size() : 0;
      const double weight = 1 / static_cast<double>(neighbours.size() + beyond);
      add(v, v, -1);
      for (const Index u : neighbours) add(v, u, weight);
      for (std::size_t i = 0; i < beyond; ++i) {
        right.row(v) -= weight * outline_.around[v][i].transpose();
      }
    }
    Eigen::SparseMatrix<double> umbrellas(all, all - n);
    umbrellas.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> normal = umbrellas.transpose() * umbrellas;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
    if (solver.info() != Eigen::Success) return;
    const Eigen::MatrixX3d places = solver.solve(umbrellas.transpose() * right);
    for (Index v = n; v < all; ++v) {
      surface_.set_point(vertex(v), to_openmesh(places.row(v - n).transpose()));
    }
  }

  /// No faces where one has no area.
  [[nodiscard]] HolePatch result() const {
    HolePatch patch;
    for (const auto face : surface_.faces()) {
      const std::array<OpenMesh::VertexHandle, 3> corners = corners_of(face);
      if (smallest_angle(place(corners[0]), place(corners[1]), place(corners[2])) < kLeastAngle) {
        return {};
      }
      patch.faces.push_back({corners[0].idx(), corners[1].idx(), corners[2].idx()});
    }
    for (std::size_t v = outline_.places.size(); v < surface_.n_vertices(); ++v) {
      patch.inside.push_back(place(vertex(static_cast<Index>(v))));
    }
    return patch;
  }

 private:
  static OpenMesh::VertexHandle vertex(Index v) { return OpenMesh::VertexHandle(v); }
  [[nodiscard]] Vec3 place(OpenMesh::VertexHandle v) const {
    return from_openmesh(surface_.point(v));
  }

  [[nodiscard]] std::array<OpenMesh::VertexHandle, 3> corners_of(OpenMesh::FaceHandle face) const {
    const auto first = surface_.halfedge_handle(face);
    const auto second = surface_.next_halfedge_handle(first);
    return {surface_.from_vertex_handle(first), surface_.to_vertex_handle(first),
            surface_.to_vertex_handle(second)};
  }

  [[nodiscard]] std::vector<Index> neighbours_of(Index v) const {
    std::vector<Index> neighbours;
    for (const auto u : surface_.vv_range(vertex(v))) neighbours.push_back(u.idx());
    return neighbours;
  }

  void divide_face(OpenMesh::FaceHandle face) {
    const std::array<OpenMesh::VertexHandle, 3> corners = corners_of(face);
    Vec3 middle = Vec3::Zero();
    double size = 0;
    for (const auto v : corners) {
      middle += place(v) / 3;
      size += sizes_[v.idx()] / 3;
    }
    const bool is_large = std::ranges::all_of(corners, [&](OpenMesh::VertexHandle v) {
      return std::numbers::sqrt2 * (place(v) - middle).norm() > std::max(size, sizes_[v.idx()]);
    });
    if (!is_large) return;
    surface_.split(face, surface_.add_vertex(to_openmesh(middle)));
    sizes_.push_back(size);
  }

  [[nodiscard]] bool should_turn(OpenMesh::EdgeHandle edge) const {
    if (surface_.is_boundary(edge) || !surface_.is_flip_ok(edge)) return false;
    const auto h = surface_.halfedge_handle(edge, 0);
    const auto a = surface_.from_vertex_handle(h);
    const auto b = surface_.to_vertex_handle(h);
    const auto left = surface_.opposite_vh(h);
    const auto right = surface_.opposite_he_opposite_vh(h);
    const auto n = static_cast<int>(outline_.places.size());
    if (left.idx() < n && right.idx() < n &&
        !may_join_(static_cast<std::size_t>(left.idx()), static_cast<std::size_t>(right.idx()))) {
      return false;
    }
    const auto angle = [&](OpenMesh::VertexHandle apex) {
      const Vec3 to_a = place(a) - place(apex);
      const Vec3 to_b = place(b) - place(apex);
      return std::atan2(to_a.cross(to_b).norm(), to_a.dot(to_b));
    };
    if (!(angle(left) + angle(right) > std::numbers::pi + kRelaxed)) return false;
    const auto normal = [&](OpenMesh::VertexHandle i, OpenMesh::VertexHandle j,
                            OpenMesh::VertexHandle k) {
      return Vec3((place(j) - place(i)).cross(place(k) - place(i)));
    };
    const Vec3 before = normal(a, b, left) + normal(b, a, right);
    return normal(a, right, left).dot(before) > 0 && normal(b, left, right).dot(before) > 0;
  }

  const HoleOutline& outline_;
  const MayJoin& may_join_;
  Surface surface_;
  std::vector<double> sizes_;  ///< [V] how long edges are to be
};

}  // namespace

HolePatch patch_of(const HoleOutline& outline, const MayJoin& may_join) {
  Part whole{Corners(outline.places.size()), outline.beyond};
  std::iota(whole.corners.begin(), whole.corners.end(), 0U);
  std::vector<Triangle> faces;
  Patch patch(outline, may_join);
  if (!fill(outline, may_join, whole, faces) || !patch.add(faces)) return {};
  patch.divide();
  patch.fair();
  patch.relax();
  patch.fair();
  return patch.result();
}

}  // namespace strake::import
