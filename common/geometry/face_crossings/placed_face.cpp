#include "common/geometry/face_crossings/placed_face.h"

#include <algorithm>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {

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
  return a.box.intersects(b.box) && std::ranges::any_of(a.triangles, [&](const auto& one) {
           return std::ranges::any_of(
               b.triangles, [&](const auto& other) { return triangles_cross(one, other); });
         });
}

}  // namespace strake
