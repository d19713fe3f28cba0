#include "common/geometry/face_crossings/placed_face.h"

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

BoxTree::Box box_around(const std::array<Vec3, 3>& triangle) {
  BoxTree::Box box(triangle[0]);
  return box.extend(triangle[1]).extend(triangle[2]);
}

}  // namespace

PlacedFace placed_face(const std::vector<Vec3>& positions, std::span<const Index> polygon) {
  PlacedFace placed;
  for (const Index v : polygon) placed.box.extend(positions[v]);
  std::vector<std::array<Index, 3>> triangles;
  triangulate_face(positions, polygon, triangles);
  for (const auto& [a, b, c] : triangles) {
    placed.triangles.push_back({positions[a], positions[b], positions[c]});
  }
  return placed;
}

bool faces_cross(const PlacedFace& a, const PlacedFace& b) {
  if (!a.box.intersects(b.box)) return false;
  for (const std::array<Vec3, 3>& one : a.triangles) {
    const BoxTree::Box box = box_around(one);
    for (const std::array<Vec3, 3>& other : b.triangles) {
      if (box.intersects(box_around(other)) && triangles_cross(one, other)) return true;
    }
  }
  return false;
}

}  // namespace strake
