#include "stages/import/attribute_borders.h"

#include <algorithm>
#include <cmath>

namespace strake::import {

bool is_label_border(const TriMesh& mesh, Index halfedge) {
  const Index a = TriMesh::face_of(halfedge);
  const Index b = TriMesh::face_of(mesh.twin[halfedge]);
  return std::any_of(
      mesh.attributes.labels.begin(), mesh.attributes.labels.end(),
      [&](const FaceLabels& labels) { return labels.of_face[a] != labels.of_face[b]; });
}

bool is_seam(const TriMesh& mesh, Index halfedge) {
  constexpr double kEqual = 1e-6;
  const auto& texture = mesh.attributes.texture;
  if (texture.empty()) return false;
  const auto differ = [&](Index one, Index other) {
    return std::abs(texture[one][0] - texture[other][0]) > kEqual ||
           std::abs(texture[one][1] - texture[other][1]) > kEqual;
  };
  const Index twin = mesh.twin[halfedge];
  return differ(halfedge, TriMesh::next(twin)) || differ(TriMesh::next(halfedge), twin);
}

}  // namespace strake::import
