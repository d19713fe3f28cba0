#include "common/geometry/face_crossings/crossing_places.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

/// The middle of a face, and how far its corners are from it.
std::pair<Vec3, double> middle_of(const PolyMesh& mesh, Index face) {
  const std::span<const Index> corners = mesh.face(face);
  Vec3 middle = Vec3::Zero();
  for (const Index v : corners) middle += mesh.positions[v] / static_cast<double>(corners.size());
  double reach = 0;
  for (const Index v : corners) reach = std::max(reach, (mesh.positions[v] - middle).norm());
  return {middle, reach};
}

}  // namespace

std::vector<Index> CrossingPlaces::faces_of(const PolyMesh& result) {
  std::map<Index, bool> excused;  // by face
  const auto is_excused = [&](Index f) {
    const auto [at, is_new] = excused.try_emplace(f, false);
    if (is_new) {
      const auto [middle, reach] = middle_of(result, f);
      at->second = is_crossed_by_itself(middle - mesh_.origin, reach);
    }
    return at->second;
  };
  std::set<Index> faces;
  for (const auto& pair : find_crossing_faces(result.positions, triangulate_faces(result))) {
    if (std::ranges::none_of(pair, is_excused)) faces.insert(pair.begin(), pair.end());
  }
  return {faces.begin(), faces.end()};
}

std::vector<Vec3> CrossingPlaces::of(const PolyMesh& result) {
  std::vector<Vec3> places;
  for (const Index f : faces_of(result)) {
    places.push_back(middle_of(result, f).first - mesh_.origin);
  }
  return places;
}

bool CrossingPlaces::is_crossed_by_itself(const Vec3& place, double reach) {
  if (!is_known_) {
    is_known_ = true;
    FaceTriangles triangles{mesh_.faces, std::vector<Index>(mesh_.faces.size())};
    std::iota(triangles.face.begin(), triangles.face.end(), 0);
    std::set<Index> faces;
    for (const auto& pair : find_crossing_faces(mesh_.positions, triangles)) {
      faces.insert(pair.begin(), pair.end());
    }
    for (const Index f : faces) crossing_.push_back(mesh_.faces[f]);
    if (!crossing_.empty()) own_ = std::make_unique<SurfaceDistance>(mesh_.positions, crossing_);
  }
  return own_ != nullptr && own_->closest_within(place, reach).triangle != kNone;
}

}  // namespace strake
