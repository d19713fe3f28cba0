#include "stages/mesh/halfedge_check.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <vector>

namespace strake {

std::string halfedge_defect(const PolyMesh& mesh) {
  OpenMesh::PolyMesh_ArrayKernelT<> halfedges;
  halfedges.reserve(static_cast<std::size_t>(mesh.vertex_count()), mesh.corners.size(),
                    static_cast<std::size_t>(mesh.face_count()));
  for (Index v = 0; v < mesh.vertex_count(); ++v) halfedges.new_vertex();
  std::vector<OpenMesh::VertexHandle> corners;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    corners.clear();
    for (const Index v : mesh.face(f)) corners.emplace_back(v);
    if (!halfedges.add_face(corners).is_valid()) {
      return "face " + std::to_string(f) + " does not fit the faces before it";
    }
  }
  for (const auto vertex : halfedges.vertices()) {
    if (!halfedges.is_manifold(vertex)) {
      return "vertex " + std::to_string(vertex.idx()) + " joins several fans of faces";
    }
  }
  return "";
}

}  // namespace strake
