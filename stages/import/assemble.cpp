#include "stages/import/assemble.h"

#include <vector>

#include "common/geometry/topology/topology.h"

namespace strake::import {
namespace {

std::vector<Index> breadth_first_order(const TriMesh& mesh) {
  std::vector<Index> order;
  order.reserve(mesh.faces.size());
  std::vector<std::uint8_t> seen(mesh.faces.size(), 0);
  std::size_t head = 0;
  for (Index seed = 0; seed < mesh.face_count(); ++seed) {
    if (seen[seed] != 0) continue;
    seen[seed] = 1;
    order.push_back(seed);
    for (; head < order.size(); ++head) {
      for (Index h = 3 * order[head]; h < 3 * order[head] + 3; ++h) {
        if (mesh.twin[h] == kNone || seen[mesh.twin[h] / 3] != 0) continue;
        seen[mesh.twin[h] / 3] = 1;
        order.push_back(mesh.twin[h] / 3);
      }
    }
  }
  return order;
}

}  // namespace

TriMesh assemble(const Soup& soup) {
  TriMesh unordered;
  unordered.positions = soup.positions;
  unordered.faces = soup.faces;
  build_topology(unordered);

  TriMesh mesh;
  mesh.faces.reserve(soup.faces.size());
  mesh.source_face.reserve(soup.faces.size());
  mesh.positions.reserve(soup.positions.size());
  mesh.source_vertex.reserve(soup.positions.size());
  std::vector<Index> new_index(soup.positions.size(), kNone);
  for (const Index f : breadth_first_order(unordered)) {
    Triangle face = soup.faces[f];
    for (Index& v : face) {
      if (new_index[v] == kNone) {
        new_index[v] = mesh.vertex_count();
        mesh.positions.push_back(soup.positions[v]);
        mesh.source_vertex.push_back(soup.source_vertex[v]);
      }
      v = new_index[v];
    }
    mesh.faces.push_back(face);
    mesh.source_face.push_back(soup.source_face[f]);
    if (soup.texture.empty()) continue;
    for (const TexturePoint& point : soup.texture[f]) mesh.attributes.texture.push_back(point);
  }
  build_topology(mesh);
  return mesh;
}

}  // namespace strake::import
