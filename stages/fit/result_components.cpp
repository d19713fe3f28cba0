#include "stages/fit/result_components.h"

#include <span>

#include "common/core/disjoint_sets.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake::fitting {
namespace {

/// The vertex of the input that a vertex of a result lies at; kNone: at none.
Index input_vertex(const TriMesh& mesh, const QuadMesh& quads, Index v) {
  for (int i = 0; i < 3; ++i) {
    if (quads.provenance.barycentric[v][i] == 1) return mesh.faces[quads.provenance.face[v]][i];
  }
  return kNone;
}

bool is_input_face(const TriMesh& mesh, const QuadMesh& quads, std::span<const Index> face) {
  if (face.size() != 3) return false;
  const Index a = input_vertex(mesh, quads, face[0]);
  const Index b = input_vertex(mesh, quads, face[1]);
  const Index c = input_vertex(mesh, quads, face[2]);
  if (a == kNone || b == kNone || c == kNone) return false;
  return any_outgoing(mesh, a,
                      [&](Index h) { return mesh.to(h) == b && mesh.from(TriMesh::prev(h)) == c; });
}

}  // namespace

std::vector<Index> vertex_components(const PolyMesh& mesh) {
  DisjointSets sets(mesh.vertex_count());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (const Index v : mesh.face(f)) sets.unite(mesh.face(f)[0], v);
  }
  std::vector<Index> component;
  component.reserve(mesh.positions.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) component.push_back(sets.find(v));
  return component;
}

std::vector<std::uint8_t> vertices_of_input(const TriMesh& mesh, const QuadMesh& quads,
                                            const std::vector<Index>& component) {
  std::vector<std::uint8_t> is_input(component.size(), 1);  // of components, by their name
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    std::uint8_t& all = is_input[component[quads.mesh.face(f)[0]]];
    if (all != 0 && !is_input_face(mesh, quads, quads.mesh.face(f))) all = 0;
  }
  std::vector<std::uint8_t> of_vertex;
  of_vertex.reserve(component.size());
  for (const Index c : component) of_vertex.push_back(is_input[c]);
  return of_vertex;
}

}  // namespace strake::fitting
