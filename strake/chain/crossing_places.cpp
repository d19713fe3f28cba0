#include "strake/chain/crossing_places.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

std::set<Index> crossing_faces(const std::vector<Vec3>& positions, const FaceTriangles& triangles) {
  std::set<Index> faces;
  for (const auto& pair : find_crossing_faces(positions, triangles)) {
    faces.insert(pair.begin(), pair.end());
  }
  return faces;
}

}  // namespace

std::vector<Vec3> CrossingPlaces::of(const PolyMesh& result) {
  std::vector<Vec3> places;
  for (const Index f : crossing_faces(result.positions, triangulate_faces(result))) {
    const std::span<const Index> face = result.face(f);
    Vec3 middle = Vec3::Zero();
    for (const Index v : face) middle += result.positions[v] / static_cast<double>(face.size());
    double reach = 0;
    for (const Index v : face) reach = std::max(reach, (result.positions[v] - middle).norm());
    middle -= mesh_.origin;
    if (!is_crossed_by_itself(middle, reach)) places.push_back(middle);
  }
  return places;
}

bool CrossingPlaces::is_crossed_by_itself(const Vec3& place, double reach) {
  if (!is_known_) {
    is_known_ = true;
    FaceTriangles triangles{mesh_.faces, std::vector<Index>(mesh_.faces.size())};
    std::iota(triangles.face.begin(), triangles.face.end(), 0);
    for (const Index f : crossing_faces(mesh_.positions, triangles)) {
      crossing_.push_back(mesh_.faces[f]);
    }
    if (!crossing_.empty()) own_ = std::make_unique<SurfaceDistance>(mesh_.positions, crossing_);
  }
  return own_ != nullptr && own_->closest_within(place, reach).triangle != kNone;
}

}  // namespace strake
