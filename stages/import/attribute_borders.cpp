#include "stages/import/attribute_borders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/frames.h"

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

MirrorLines::MirrorLines(const TriMesh& mesh) : mesh_(mesh) {
  if (mesh.attributes.texture.empty()) return;
  double sum = 0;
  double total = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const double area = face_area(mesh, f);
    const double texture = texture_area(f);
    sum += std::abs(texture);
    total += area;
    density_.push_back(area > 0 ? texture / area : 0);
  }
  const double mean = sum / total;
  for (double& density : density_) density /= mean;
}

double MirrorLines::texture_area(Index face) const {
  const auto corner = [&](int i) {
    const TexturePoint& at = mesh_.attributes.texture[3 * static_cast<std::size_t>(face) + i];
    return Vec2(at[0], at[1]);
  };
  const Vec2 a = corner(1) - corner(0);
  const Vec2 b = corner(2) - corner(0);
  return (a.x() * b.y() - a.y() * b.x()) / 2;
}

bool MirrorLines::contains(Index halfedge) const {
  constexpr double kDense = 0.4;
  if (density_.empty()) return false;
  const double here = density_[TriMesh::face_of(halfedge)];
  const double there = density_[TriMesh::face_of(mesh_.twin[halfedge])];
  return here * there < 0 && std::min(std::abs(here), std::abs(there)) > kDense;
}

}  // namespace strake::import
