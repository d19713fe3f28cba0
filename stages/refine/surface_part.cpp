#include "stages/refine/surface_part.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <map>
#include <queue>
#include <set>
#include <unordered_set>
#include <utility>

#include "common/core/error.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/refine/enclosed.h"
#include "stages/refine/openmesh_silence.h"

namespace strake {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  VertexTraits { SurfacePoint on; };
  FaceTraits { Index parent = kNone; };
  EdgeTraits { bool is_boundary = false; };  // of the surface, not only of its part
};
using Part = OpenMesh::TriMesh_ArrayKernelT<Traits>;

Vec3 place(const Part& part, OpenMesh::VertexHandle v) {
  const OpenMesh::Vec3d& p = part.point(v);
  return {p[0], p[1], p[2]};
}

SurfacePoint point_of_face(const TriMesh& mesh, Index face, const Vec3& p) {
  const auto& [a, b, c] = mesh.faces[face];
  return {face,
          closest_point_on_triangle(p, mesh.positions[a], mesh.positions[b], mesh.positions[c])
              .barycentric};
}

/// Faces joined to some by others that may reach into a box, and what these enclose; none where
/// there are more than `most` without that.
std::set<Index> faces_in(const TriMesh& mesh, const std::vector<Index>& faces,
                         const Eigen::AlignedBox3d& box, std::size_t most) {
  std::vector<Index> queue = faces;
  std::sort(queue.begin(), queue.end());
  queue.erase(std::unique(queue.begin(), queue.end()), queue.end());
  std::unordered_set<Index> is_seen(queue.begin(), queue.end());
  for (std::size_t i = 0; i < queue.size() && queue.size() <= most; ++i) {
    for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
      if (mesh.is_boundary(h)) continue;
      const Index g = TriMesh::face_of(mesh.twin[h]);
      if (is_seen.contains(g)) continue;
      Eigen::AlignedBox3d around;
      for (const Index v : mesh.faces[g]) around.extend(mesh.positions[v]);
      if (!around.intersects(box)) continue;
      is_seen.insert(g);
      queue.push_back(g);
    }
  }
  if (queue.size() > most) return {};
  std::set<Index> seen(queue.begin(), queue.end());
  // The boundary is no way out: what rises there above the box is a part of it, too.
  add_enclosed(seen, [&](Index f, const auto& visit) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      if (!mesh.is_boundary(h)) visit(TriMesh::face_of(mesh.twin[h]));
    }
  });
  return seen;
}

Part to_openmesh(const TriMesh& mesh, const std::set<Index>& faces) {
  const OpenMeshSilence silence;
  Part part;
  std::map<Index, OpenMesh::VertexHandle> vertex;
  for (const Index f : faces) {
    for (const Index v : mesh.faces[f]) {
      const auto [at, is_new] = vertex.try_emplace(v);
      if (!is_new) continue;
      const Vec3& p = mesh.positions[v];
      at->second = part.add_vertex({p.x(), p.y(), p.z()});
      part.data(at->second).on = point_of_face(mesh, f, p);
    }
  }
  for (const Index f : faces) {
    const auto& [a, b, c] = mesh.faces[f];
    const auto face = part.add_face(vertex[a], vertex[b], vertex[c]);
    if (!face.is_valid()) return {};  // two parts that meet in a vertex
    part.data(face).parent = f;
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      if (!mesh.is_boundary(h)) continue;
      const auto side = part.find_halfedge(vertex[mesh.from(h)], vertex[mesh.to(h)]);
      part.data(part.edge_handle(side)).is_boundary = true;
    }
  }
  return part;
}

/// \return whether it has at most as many faces
bool divide(const TriMesh& mesh, const Eigen::AlignedBox3d& box, double longest, std::size_t most,
            Part& part) {
  using Entry = std::pair<double, int>;  // length, edge
  std::priority_queue<Entry> queue;
  const auto consider = [&](OpenMesh::EdgeHandle edge) {
    const auto h = part.halfedge_handle(edge, 0);
    const Vec3 a = place(part, part.from_vertex_handle(h));
    const Vec3 b = place(part, part.to_vertex_handle(h));
    const double length = (b - a).norm();
    Eigen::AlignedBox3d around(a);
    around.extend(b);
    if (length > longest && around.intersects(box)) queue.emplace(length, edge.idx());
  };
  for (const auto edge : part.edges()) consider(edge);
  while (!queue.empty() && part.n_faces() <= most) {
    const OpenMesh::EdgeHandle edge(queue.top().second);
    queue.pop();
    auto h = part.halfedge_handle(edge, 0);
    if (part.is_boundary(h)) h = part.opposite_halfedge_handle(h);
    const Index parent = part.data(part.face_handle(h)).parent;
    const OpenMesh::Vec3d middle = part.calc_edge_midpoint(edge);
    const auto v = part.split_copy(edge, middle);
    part.data(v).on = point_of_face(mesh, parent, place(part, v));
    for (const auto beside : part.ve_range(v)) consider(beside);
  }
  return queue.empty() && part.n_faces() <= most;
}

}  // namespace

SurfacePart surface_part(const TriMesh& mesh, const std::vector<Index>& faces,
                         const Eigen::AlignedBox3d& box, double longest, std::size_t most) {
  SurfacePart result;
  Part part = to_openmesh(mesh, faces_in(mesh, faces, box, most));
  if (!divide(mesh, box, longest, most, part)) return result;
  for (const auto v : part.vertices()) {
    result.points.push_back(part.data(v).on);
    result.positions.push_back(place(part, v));
  }
  for (const auto face : part.faces()) {
    std::array<Index, 3>& corners = result.faces.emplace_back();
    std::array<Index, 3>& neighbours = result.neighbours.emplace_back();
    std::size_t i = 0;
    for (const auto h : part.fh_range(face)) {
      corners[i] = h.from().idx();
      if (part.data(h.edge()).is_boundary) result.boundary.emplace(h.from().idx(), h.to().idx());
      neighbours[i++] = h.opp().is_boundary() ? kNone : h.opp().face().idx();
    }
    result.parent.push_back(part.data(face).parent);
  }
  return result;
}

}  // namespace strake
