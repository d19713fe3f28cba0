#include "common/geometry/poly_topology/vertex_faces.h"

#include <algorithm>

namespace strake {

VertexFaces::VertexFaces(const PolyMesh& mesh)
    : mesh_(mesh),
      offsets_(mesh.positions.size() + 1, 0),
      corners_(mesh.corners.size()),
      faces_(mesh.corners.size()) {
  for (const Index v : mesh.corners) ++offsets_[v + 1];
  for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (Index c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
      const Index row = next[mesh.corners[c]]++;
      corners_[row] = c;
      faces_[row] = f;
    }
  }
}

std::vector<Index> VertexFaces::neighbours(Index vertex) const {
  std::vector<Index> result;
  for (Index row = offsets_[vertex]; row < offsets_[vertex + 1]; ++row) {
    result.push_back(mesh_.corners[mesh_.next_corner(faces_[row], corners_[row])]);
    result.push_back(mesh_.corners[mesh_.previous_corner(faces_[row], corners_[row])]);
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

Index VertexFaces::face_with_side(Index from, Index to) const {
  for (Index row = offsets_[from + 1] - 1; row >= offsets_[from]; --row) {
    if (mesh_.corners[mesh_.next_corner(faces_[row], corners_[row])] == to) return faces_[row];
  }
  return kNone;
}

}  // namespace strake
