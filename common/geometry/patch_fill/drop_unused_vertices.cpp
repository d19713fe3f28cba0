#include "common/geometry/patch_fill/drop_unused_vertices.h"

#include <utility>
#include <vector>

namespace strake {

void drop_unused_vertices(QuadMesh& quads) {
  PolyMesh& mesh = quads.mesh;
  std::vector<Index> number(mesh.positions.size(), kNone);
  for (const Index v : mesh.corners) number[v] = 0;
  std::vector<Vec3> positions;
  VertexProvenance provenance;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kNone) continue;
    number[v] = static_cast<Index>(positions.size());
    positions.push_back(mesh.positions[v]);
    provenance.face.push_back(quads.provenance.face[v]);
    provenance.barycentric.push_back(quads.provenance.barycentric[v]);
    provenance.lines.push_back(quads.provenance.lines[v]);
  }
  for (Index& v : mesh.corners) v = number[v];
  mesh.positions = std::move(positions);
  quads.provenance = std::move(provenance);
}

}  // namespace strake
