#include "stages/coarsen/coarsen.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "common/geometry/mesh_measures.h"
#include "common/geometry/topology/topology.h"
#include "common/geometry/topology/vertex_ring.h"
#include "stages/coarsen/plane_quadric.h"

namespace strake {
namespace {

using coarsening::PlaneQuadric;

/// Vertices with more neighbours stay.
constexpr int kMostNeighbours = 24;
/// Longest new edge, in mean distances of the vertices wanted.
constexpr double kLongest = 2.5;
/// Least cosine between the normals of a face before and after a collapse.
constexpr double kLeastTurn = 0.5;
/// Least area of a new face, over its longest edge squared; or as much as the face had before.
constexpr double kLeastShape = 0.05;
/// Share of the vertices that may go, cheapest first, that are looked at in one pass. With more the
/// dear ones go whose cheap neighbours have just gone; with fewer there are more passes.
constexpr double kOnePass = 0.75;
/// A pass that finds fewer, as a share of those still to go, is the last.
constexpr double kWorthPass = 0.01;

/// The collapse that costs least at a vertex.
struct Candidate {
  double cost = 0;
  Index vertex = kNone;

  bool operator<(const Candidate& other) const {
    return std::pair(cost, vertex) < std::pair(other.cost, other.vertex);
  }
};

/// A mesh whose vertices are collapsed into neighbours.
class Coarsening {
 public:
  /// \param mesh  kept by reference
  Coarsening(const TriMesh& mesh, Index wanted)
      : parent_(mesh),
        mesh_(connections(mesh)),
        wanted_(wanted),
        longest_square_(longest_square(mesh, wanted)),
        quadrics_(mesh.positions.size()),
        best_(mesh.positions.size()),
        seen_(mesh.positions.size(), 0) {
    tbb::parallel_for(Index{0}, mesh.vertex_count(), [&](Index v) {
      quadrics_[v] = quadric(v);
      best_[v].state = touches_line(v) ? State::fixed : State::changed;
    });
    for (const Best& best : best_) left_ += best.state == State::changed ? 1 : 0;
  }

  /// Collapses what costs least, once around each vertex. \return number of vertices that went
  Index pass() {
    tbb::parallel_for(Index{0}, parent_.vertex_count(), [&](Index v) {
      if (best_[v].state == State::changed) best_[v] = look(v);
    });
    const Index before = left_;
    for (const Candidate& candidate : cheapest()) {
      if (left_ <= wanted_) break;
      const Best& best = best_[candidate.vertex];
      if (best.state == State::known && keeps_topology(best.halfedge)) collapse(best.halfedge);
    }
    return before - left_;
  }

  /// Vertices that are not on feature and boundary lines.
  [[nodiscard]] Index vertices_left() const { return left_; }

  /// What is left, as a mesh; nothing can be collapsed afterwards.
  [[nodiscard]] TriMesh take_result() {
    quadrics_ = std::vector<PlaneQuadric>();  // room for the mesh; "= {}" would keep the memory
    TriMesh mesh;
    std::vector<Index> new_vertex(parent_.positions.size(), kNone);
    for (Index v = 0; v < parent_.vertex_count(); ++v) {
      if (best_[v].state == State::gone) continue;
      new_vertex[v] = mesh.vertex_count();
      mesh.positions.push_back(parent_.positions[v]);
      mesh.is_corner.push_back(parent_.is_corner[v]);
      if (!parent_.source_vertex.empty()) mesh.source_vertex.push_back(parent_.source_vertex[v]);
    }
    std::vector<Index> kept_faces;
    for (Index f = 0; f < parent_.face_count(); ++f) {
      const auto& [a, b, c] = mesh_.faces[f];
      if (a == kNone) continue;
      kept_faces.push_back(f);
      mesh.faces.push_back({new_vertex[a], new_vertex[b], new_vertex[c]});
      for (int i = 0; i < 3; ++i) mesh.is_feature.push_back(mesh_.is_feature[3 * f + i]);
      if (!parent_.source_face.empty()) mesh.source_face.push_back(parent_.source_face[f]);
    }
    build_topology(mesh);
    build_wedges(mesh);
    mesh.parent_wedge.resize(mesh.wedge_vertex.size());
    for (Index f = 0; f < mesh.face_count(); ++f) {
      for (int i = 0; i < 3; ++i) {
        mesh.parent_wedge[mesh.face_wedges[f][i]] = mesh_.face_wedges[kept_faces[f]][i];
      }
    }
    mesh.parent_id = parent_.id;
    mesh.origin = parent_.origin;
    mesh.diagonal = parent_.diagonal;
    mesh.id = content_id(mesh);
    return mesh;
  }

 private:
  enum class State : std::uint8_t {
    fixed,    ///< on a line
    stays,    ///< no collapse leaves the faces around it in order
    known,    ///< may go as `Best` says
    changed,  ///< the faces around it have changed since it was looked at
    gone
  };
  /// The cheapest collapse of a vertex.
  struct Best {
    double cost = 0;
    Index halfedge = kNone;  ///< from the vertex to where it would go
    State state = State::stays;
  };

  static TriMesh connections(const TriMesh& mesh) {
    TriMesh copy;
    copy.faces = mesh.faces;
    copy.twin = mesh.twin;
    copy.vertex_out = mesh.vertex_out;
    copy.is_feature = mesh.is_feature;
    copy.face_wedges = mesh.face_wedges;
    return copy;
  }

  static double longest_square(const TriMesh& mesh, Index wanted) {
    return kLongest * kLongest * surface_area(mesh) / wanted;
  }

  [[nodiscard]] const Vec3& at(Index v) const { return parent_.positions[v]; }

  [[nodiscard]] bool touches_line(Index v) const {
    return parent_.is_corner[v] != 0 ||
           any_outgoing(mesh_, v, [&](Index h) { return mesh_.is_barrier(h); });
  }

  [[nodiscard]] PlaneQuadric quadric(Index v) const {
    PlaneQuadric sum;
    for_each_outgoing(mesh_, v, [&](Index h) {
      const auto& [a, b, c] = mesh_.faces[TriMesh::face_of(h)];
      const Vec3 cross = (at(b) - at(a)).cross(at(c) - at(a));
      const double length = cross.norm();
      if (!(length > 0)) return;
      const Vec3 normal = cross / length;
      sum.add_plane(normal, -normal.dot(at(a)), length / 2);
    });
    return sum;
  }

  /// The cheapest collapse of a vertex that leaves the faces around it in order.
  [[nodiscard]] Best look(Index v) const {
    std::array<std::pair<double, Index>, kMostNeighbours> ways;  // cost and half-edge
    std::size_t count = 0;
    const bool has_more = any_outgoing(mesh_, v, [&](Index h) {
      if (count == ways.size()) return true;
      const Vec3& p = at(mesh_.to(h));
      ways[count++] = {std::max(quadrics_[v].at(p) + quadrics_[mesh_.to(h)].at(p), 0.0), h};
      return false;
    });
    if (has_more) return {};
    std::sort(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [cost, halfedge] = ways[i];
      if (keeps_shape(halfedge)) return {cost, halfedge, State::known};
    }
    return {};
  }

  /// Whether the faces around a vertex that goes are left in order, but for the two that go too.
  [[nodiscard]] bool keeps_shape(Index halfedge) const {
    const Index target = mesh_.to(halfedge);
    const auto spoils = [&](Index h) {
      const Index b = mesh_.to(h);
      const Index c = mesh_.from(TriMesh::prev(h));
      return b != target && c != target &&
             !keeps_face(at(mesh_.from(halfedge)), at(target), at(b), at(c));
    };
    return !any_outgoing(mesh_, mesh_.from(halfedge), spoils);
  }

  /// Whether a face may become that of `after` and the two vertices that it keeps.
  [[nodiscard]] bool keeps_face(const Vec3& before, const Vec3& after, const Vec3& b,
                                const Vec3& c) const {
    const Vec3 kept = c - b;
    const Vec3 old_normal = (before - b).cross(kept);
    const Vec3 new_normal = (after - b).cross(kept);
    const double cosine = old_normal.dot(new_normal);
    const double old_square = old_normal.squaredNorm();
    const double new_square = new_normal.squaredNorm();
    if (!(cosine > 0) || cosine * cosine < kLeastTurn * kLeastTurn * old_square * new_square) {
      return false;
    }
    const double new_edges = std::max((after - b).squaredNorm(), (after - c).squaredNorm());
    if (new_edges > longest_square_) return false;
    const double old_edges = std::max((before - b).squaredNorm(), (before - c).squaredNorm());
    const double old_longest = std::max(old_edges, kept.squaredNorm());
    const double new_longest = std::max(new_edges, kept.squaredNorm());
    const double new_shape = new_square / (new_longest * new_longest);
    return new_shape >=
           std::min(kLeastShape * kLeastShape, old_square / (old_longest * old_longest));
  }

  /// Those that are looked at in one pass, cheapest first.
  [[nodiscard]] std::vector<Candidate> cheapest() const {
    std::vector<Candidate> candidates;
    for (Index v = 0; v < parent_.vertex_count(); ++v) {
      if (best_[v].state == State::known) candidates.push_back({best_[v].cost, v});
    }
    tbb::parallel_sort(candidates);
    candidates.resize(
        static_cast<std::size_t>(std::ceil(kOnePass * static_cast<double>(candidates.size()))));
    return candidates;
  }

  /// Whether the surface stays a manifold of the same topology: the link condition (Dey et al.
  /// 1999).
  [[nodiscard]] bool keeps_topology(Index halfedge) {
    ++stamp_;
    for_each_neighbour(mesh_, mesh_.from(halfedge), [&](Index v) { seen_[v] = stamp_; });
    int common = 0;
    for_each_neighbour(mesh_, mesh_.to(halfedge),
                       [&](Index v) { common += seen_[v] == stamp_ ? 1 : 0; });
    if (common != 2) return false;
    const auto can_lose_an_edge = [&](Index v) {
      int neighbours = 0;
      for_each_neighbour(mesh_, v, [&](Index) { ++neighbours; });
      return neighbours > 3;
    };
    return can_lose_an_edge(mesh_.from(TriMesh::prev(halfedge))) &&
           can_lose_an_edge(mesh_.from(TriMesh::prev(mesh_.twin[halfedge])));
  }

  /// Gives a half-edge of the vertex that goes the place of one of a face that goes too.
  void replace(Index lost, Index by) {
    const Index twin = mesh_.twin[lost];
    mesh_.twin[by] = twin;
    if (twin != kNone) mesh_.twin[twin] = by;
    mesh_.is_feature[by] = mesh_.is_feature[lost];
  }

  void collapse(Index halfedge) {
    const Index gone = mesh_.from(halfedge);
    const Index target = mesh_.to(halfedge);
    const Index wedge = mesh_.wedge_of(TriMesh::next(halfedge));
    std::array<Index, kMostNeighbours> out;
    std::size_t count = 0;
    for_each_outgoing(mesh_, gone, [&](Index h) {
      out[count++] = h;
      State& state = best_[mesh_.to(h)].state;
      if (state != State::fixed) state = State::changed;
    });
    // The faces (gone, target, a) and (target, gone, b) go.
    const Index twin = mesh_.twin[halfedge];
    const Index a = mesh_.from(TriMesh::prev(halfedge));
    const Index b = mesh_.from(TriMesh::prev(twin));
    const Index to_a = mesh_.twin[TriMesh::prev(halfedge)];
    const Index from_b = mesh_.twin[TriMesh::next(twin)];
    const Index a_out = mesh_.twin[TriMesh::next(halfedge)];
    if (mesh_.vertex_out[a] == TriMesh::prev(halfedge)) mesh_.vertex_out[a] = a_out;
    if (mesh_.vertex_out[b] == TriMesh::prev(twin)) mesh_.vertex_out[b] = from_b;
    if (TriMesh::face_of(mesh_.vertex_out[target]) == TriMesh::face_of(halfedge) ||
        TriMesh::face_of(mesh_.vertex_out[target]) == TriMesh::face_of(twin)) {
      mesh_.vertex_out[target] = to_a;
    }
    replace(TriMesh::next(halfedge), to_a);
    replace(TriMesh::prev(twin), from_b);
    for (std::size_t i = 0; i < count; ++i) {
      mesh_.faces[out[i] / 3][out[i] % 3] = target;
      mesh_.face_wedges[out[i] / 3][out[i] % 3] = wedge;
    }
    for (const Index h : {halfedge, twin}) mesh_.faces[TriMesh::face_of(h)].fill(kNone);
    quadrics_[target] += quadrics_[gone];
    best_[gone].state = State::gone;
    --left_;
  }

  const TriMesh& parent_;
  TriMesh mesh_;  ///< its connections as they are now; faces that went hold kNone
  Index wanted_;
  Index left_ = 0;  ///< vertices that are not on lines
  double longest_square_;
  std::vector<PlaneQuadric> quadrics_;  ///< [V]
  std::vector<Best> best_;              ///< [V]
  std::vector<Index> seen_;             ///< [V] the last stamp of a vertex whose neighbour it was
  Index stamp_ = 0;
};

}  // namespace

CoarsenResult coarsen_mesh(const TriMesh& mesh, const CoarsenOptions& options, Observer& observer) {
  const auto wanted =
      static_cast<Index>(std::min<std::int64_t>(options.vertices, mesh.vertex_count()));
  Coarsening coarsening(mesh, wanted);
  const Index all = coarsening.vertices_left();
  const auto share_done = [&] {
    return double(all - coarsening.vertices_left()) / std::max<Index>(all - wanted, 1);
  };
  std::int64_t passes = 0;
  while (coarsening.vertices_left() > wanted) {
    observer.report("collapsing vertices", share_done());
    const double to_go = coarsening.vertices_left() - wanted;
    ++passes;
    if (coarsening.pass() <= kWorthPass * to_go) break;
  }
  observer.report("collapsing vertices", 1);
  CoarsenResult result{coarsening.take_result(), {}};
  result.report.set("coarsen.vertices", std::int64_t{result.mesh.vertex_count()});
  result.report.set("coarsen.faces", std::int64_t{result.mesh.face_count()});
  result.report.set("coarsen.passes", passes);
  return result;
}

}  // namespace strake
