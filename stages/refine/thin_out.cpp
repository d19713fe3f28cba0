#include "stages/refine/thin_out.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/core/error.h"
#include "stages/refine/openmesh_silence.h"

namespace strake {
namespace {

struct ThinTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Patch = OpenMesh::TriMesh_ArrayKernelT<ThinTraits>;

/// Largest ratio of the longest side to the height over it that a collapse may lead to. Of a
/// regular grid of halved squares each leads to 5.
constexpr float kLargestAspect = 5.5;
/// Share of the distance by which turning an edge may move the surface.
constexpr double kLargestGap = 0.25;
constexpr int kMostTurns = 10;  ///< times that all edges are looked at

/// OpenMesh's distance, another one for each vertex that may go.
template <class MeshT>
class LocalHausdorff : public OpenMesh::Decimater::ModHausdorffT<MeshT> {
 public:
  DECIMATING_MODULE(LocalHausdorff, MeshT, LocalHausdorff);

  explicit LocalHausdorff(MeshT& patch) : OpenMesh::Decimater::ModHausdorffT<MeshT>(patch) {}

  /// \param distance  [V]
  void set_distances(std::vector<double> distance) { distance_ = std::move(distance); }

  float collapse_priority(const CollapseInfo& edge) override {
    this->set_tolerance(distance_[edge.v0.idx()]);  // of the vertex that would go
    return OpenMesh::Decimater::ModHausdorffT<MeshT>::collapse_priority(edge);
  }

 private:
  std::vector<double> distance_;
};

/// Allows no new edge between two vertices of the outline: the mesh around may have it.
template <class MeshT>
class NoChords : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(NoChords, MeshT, NoChords);

  explicit NoChords(MeshT& patch) : Base(patch, true) {}

  float collapse_priority(const CollapseInfo& edge) override {
    const MeshT& patch = edge.mesh;
    if (!patch.is_boundary(edge.v1)) return Base::LEGAL_COLLAPSE;
    for (const auto v : patch.vv_range(edge.v0)) {
      if (v != edge.v1 && v != edge.vl && v != edge.vr && patch.is_boundary(v)) {
        return Base::ILLEGAL_COLLAPSE;
      }
    }
    return Base::LEGAL_COLLAPSE;
  }
};

/// Around the origin, of size one: OpenMesh takes small triangles for degenerate ones.
/// \return nothing where it does not take them as a manifold
std::optional<Patch> scaled_patch(const std::vector<Vec3>& positions,
                                  const std::vector<std::array<Index, 3>>& triangles,
                                  double scale) {
  const OpenMeshSilence silence;
  Patch patch;
  patch.request_vertex_status();
  patch.request_edge_status();
  patch.request_halfedge_status();
  patch.request_face_status();
  patch.request_face_normals();
  for (const Vec3& position : positions) {
    const Vec3 p = scale * (position - positions.front());
    patch.add_vertex({p.x(), p.y(), p.z()});
  }
  for (const auto& [a, b, c] : triangles) {
    const auto face =
        patch.add_face(Patch::VertexHandle(a), Patch::VertexHandle(b), Patch::VertexHandle(c));
    if (!face.is_valid()) return std::nullopt;
  }
  patch.update_face_normals();
  return patch;
}

/// \param distance  [V]
void decimate(Patch& patch, const std::vector<double>& distance) {
  OpenMesh::Decimater::DecimaterT<Patch> decimater(patch);
  OpenMesh::Decimater::ModQuadricT<Patch>::Handle quadrics;
  decimater.add(quadrics);
  decimater.module(quadrics).unset_max_err();
  LocalHausdorff<Patch>::Handle hausdorff;
  decimater.add(hausdorff);
  decimater.module(hausdorff).set_distances(distance);
  OpenMesh::Decimater::ModNormalFlippingT<Patch>::Handle flipping;
  decimater.add(flipping);
  OpenMesh::Decimater::ModAspectRatioT<Patch>::Handle shapes;
  decimater.add(shapes);
  decimater.module(shapes).set_aspect_ratio(kLargestAspect);
  NoChords<Patch>::Handle chords;
  decimater.add(chords);
  if (!decimater.initialize()) throw AlgorithmError("decimation does not start; please report");
  decimater.decimate();
}

/// Least height of a triangle over its longest edge, as a share of that.
double height_share(const OpenMesh::Vec3d& a, const OpenMesh::Vec3d& b, const OpenMesh::Vec3d& c) {
  const double longest = std::max({(b - a).sqrnorm(), (c - b).sqrnorm(), (a - c).sqrnorm()});
  return longest > 0 ? cross(b - a, c - a).norm() / longest : 0;
}

/// Whether an edge may be turned: it is none between vertices that stay, which may be part of a
/// line, and turned it does not join two vertices of the outline.
bool may_be_turned(const Patch& patch, OpenMesh::SmartEdgeHandle edge) {
  const bool stays = patch.status(edge.v0()).locked() && patch.status(edge.v1()).locked();
  return !stays && patch.is_flip_ok(edge) &&
         !(patch.is_boundary(edge.h0().next().to()) && patch.is_boundary(edge.h1().next().to()));
}

/// Whether turning an edge makes the worse of its two triangles better, without a fold.
/// \param gap  how far the two diagonals may be apart
bool is_better_turned(const Patch& patch, OpenMesh::SmartEdgeHandle edge, double gap) {
  const auto h = edge.h0();
  const OpenMesh::Vec3d a = patch.point(h.from());
  const OpenMesh::Vec3d b = patch.point(h.to());
  const OpenMesh::Vec3d left = patch.point(h.next().to());
  const OpenMesh::Vec3d right = patch.point(h.opp().next().to());
  const OpenMesh::Vec3d normal = cross(b - a, left - a) + cross(a - b, right - b);
  const bool folds =
      dot(cross(right - a, left - a), normal) <= 0 || dot(cross(left - b, right - b), normal) <= 0;
  const double now = std::min(height_share(a, b, left), height_share(b, a, right));
  const double then = std::min(height_share(a, right, left), height_share(b, left, right));
  const OpenMesh::Vec3d across = cross(b - a, right - left);
  const bool is_flat = std::abs(dot(left - a, across)) <= gap * across.norm();
  return is_flat && !folds && then > now;
}

/// Turns edges for better triangles. A vertex on an edge of the triangle beside it makes a sliver
/// with that edge; turned, it divides that triangle.
/// \param distance  [V]
void turn_edges(Patch& patch, const std::vector<double>& distance) {
  for (int round = 0; round < kMostTurns; ++round) {
    bool any = false;
    for (const auto edge : patch.edges()) {
      if (patch.is_boundary(edge) || !may_be_turned(patch, edge)) continue;
      const double most = std::max(distance[edge.v0().idx()], distance[edge.v1().idx()]);
      if (!is_better_turned(patch, edge, kLargestGap * most)) continue;
      patch.flip(edge);
      any = true;
    }
    if (!any) return;
  }
}

}  // namespace

std::vector<std::array<Index, 3>> thin_out(const std::vector<Vec3>& positions,
                                           const std::vector<std::array<Index, 3>>& triangles,
                                           const std::vector<double>& distance) {
  double size = 0;
  for (const Vec3& p : positions) size = std::max(size, (p - positions.front()).norm());
  const double scale = 1 / size;
  std::optional<Patch> scaled = scaled_patch(positions, triangles, scale);
  if (!scaled) return triangles;
  Patch& patch = *scaled;
  std::vector<double> scaled_distance;
  for (const auto v : patch.vertices()) {
    scaled_distance.push_back(scale * distance[v.idx()]);
    patch.status(v).set_locked(distance[v.idx()] == 0 || patch.is_boundary(v));
  }
  turn_edges(patch, scaled_distance);
  decimate(patch, scaled_distance);
  turn_edges(patch, scaled_distance);

  std::vector<std::array<Index, 3>> result;
  for (const auto face : patch.faces()) {  // those left; no garbage collection: numbers stay
    std::array<Index, 3> corners = {};
    std::size_t i = 0;
    for (const auto v : patch.fv_range(face)) corners[i++] = v.idx();
    result.push_back(corners);
  }
  return result;
}

}  // namespace strake
