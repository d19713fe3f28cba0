#include "stages/lift/lift.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "common/geometry/carry_attributes.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/surface_point.h"
#include "common/geometry/topology/own_component.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// Barycentric coordinate of a foot beside a line that it does not belong to.
constexpr double kBesideLine = 1e-6;

/// Finds the points of a mesh that points of its coarser one are.
class Lift {
 public:
  Lift(const TriMesh& mesh, const TriMesh& coarse)
      : mesh_(mesh),
        coarse_(coarse),
        surface_(mesh.positions, mesh.faces),
        normals_(mesh),
        components_(mesh),
        coarse_normals_(coarse) {}

  /// \param at  on the coarser mesh  \param place  that the foot is of, relative to the origin
  [[nodiscard]] SurfacePoint foot(const SurfacePoint& at, const Vec3& place) const {
    const Index corner = corner_at(at);
    if (corner != kNone && is_on_line(parent_of(corner))) {
      return point_at_vertex(mesh_, parent_of(corner));
    }
    const Index h = edge_at(at, [&](Index side) { return coarse_.is_barrier(side); });
    if (h == kNone) return nearest(at, place);
    return on_edge(parent_of(h), parent_of(TriMesh::next(h)), share_along(at, h));
  }

 private:
  /// Vertex of the mesh at a corner of the coarser one.
  [[nodiscard]] Index parent_of(Index corner) const {
    return mesh_.wedge_vertex[coarse_.parent_wedge[coarse_.wedge_of(corner)]];
  }

  [[nodiscard]] bool is_on_line(Index vertex) const {
    return mesh_.is_corner[vertex] != 0 ||
           any_outgoing(mesh_, vertex, [&](Index h) { return mesh_.is_barrier(h); });
  }

  /// \param share  of the way from one end to the other
  [[nodiscard]] SurfacePoint on_edge(Index from, Index to, double share) const {
    const auto is_next = [&](Index h) { return mesh_.from(TriMesh::prev(h)) == to; };
    // Of a face that has the edge as the one or the other of its two sides there.
    const Index h =
        find_outgoing(mesh_, from, [&](Index out) { return mesh_.to(out) == to || is_next(out); });
    if (h == kNone) return {};
    if (mesh_.to(h) == to) return point_along(h, share);
    SurfacePoint point{TriMesh::face_of(h), {0, 0, 0}};
    point.barycentric[h % 3] = 1 - share;
    point.barycentric[TriMesh::prev(h) % 3] = share;
    return point;
  }

  [[nodiscard]] SurfacePoint nearest(const SurfacePoint& at, const Vec3& place) const {
    const int heaviest =
        static_cast<int>(std::ranges::max_element(at.barycentric) - at.barycentric.begin());
    const Index known = parent_of(3 * at.face + heaviest);
    const Index known_face = TriMesh::face_of(mesh_.vertex_out[known]);
    const Vec3 side = coarse_normals_[at.face];
    const ClosestPoint found =
        surface_.closest_if(place, (place - mesh_.positions[known]).norm(), [&](Index f) {
          return f == known_face ||
                 (normals_[f].dot(side) > kSameSheet && components_.has_both(f, known_face));
        });
    SurfacePoint point = found.triangle == kNone ? point_at_vertex(mesh_, known)
                                                 : SurfacePoint{found.triangle, found.barycentric};
    // It may touch a line, but is not of it.
    for (double& share : point.barycentric) share = (1 - 3 * kBesideLine) * share + kBesideLine;
    return point;
  }

  const TriMesh& mesh_;
  const TriMesh& coarse_;
  SurfaceDistance surface_;
  FaceNormals normals_;
  OwnComponent components_;
  FaceNormals coarse_normals_;
};

}  // namespace

QuadMesh lift_quads(const TriMesh& mesh, const TriMesh& coarse, const QuadMesh& quads) {
  const Lift lift(mesh, coarse);
  QuadMesh lifted = quads;
  lifted.mesh_id = mesh.id;
  VertexProvenance& provenance = lifted.provenance;
  tbb::parallel_for(Index{0}, quads.mesh.vertex_count(), [&](Index v) {
    set_foot(provenance, v,
             lift.foot(foot_of(quads.provenance, v), quads.mesh.positions[v] - mesh.origin));
  });
  lifted.mesh.attributes = carry_attributes(mesh, lifted.mesh, provenance);
  return lifted;
}

}  // namespace strake
