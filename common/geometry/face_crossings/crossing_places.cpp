#include "common/geometry/face_crossings/crossing_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

/// Looks at the input around single places, before all of it is: a few such looks cost less.
constexpr int kMostLooks = 4;

}  // namespace

CrossingPlaces::Place CrossingPlaces::place_of(const PolyMesh& result, Index face) const {
  const std::span<const Index> corners = result.face(face);
  Vec3 middle = Vec3::Zero();
  for (const Index v : corners) middle += result.positions[v] / static_cast<double>(corners.size());
  double reach = 0;
  for (const Index v : corners) reach = std::max(reach, (result.positions[v] - middle).norm());
  return {middle - mesh_.origin, reach};
}

std::vector<Index> CrossingPlaces::faces_of(const PolyMesh& result) {
  const auto pairs = find_crossing_faces(result.positions, triangulate_faces(result));
  std::map<Index, Place> places;  // by face
  for (const auto& pair : pairs) {
    for (const Index f : pair) places.try_emplace(f, place_of(result, f));
  }
  std::vector<Place> all;
  for (const auto& [face, place] : places) all.push_back(place);
  look_around(all);
  std::set<Index> faces;
  for (const auto& pair : pairs) {
    if (std::ranges::none_of(pair, [&](Index f) { return is_crossed_by_itself(places.at(f)); })) {
      faces.insert(pair.begin(), pair.end());
    }
  }
  return {faces.begin(), faces.end()};
}

std::vector<Vec3> CrossingPlaces::of(const PolyMesh& result) {
  std::vector<Vec3> middles;
  for (const Index f : faces_of(result)) middles.push_back(place_of(result, f).middle);
  return middles;
}

void CrossingPlaces::look_around(const std::vector<Place>& places) {
  if (places.empty() || looks_ > kMostLooks) return;
  ++looks_;
  is_seen_.resize(mesh_.faces.size(), 0);
  std::vector<BoxTree::Box> boxes;
  for (const auto& [middle, reach] : places) {
    boxes.emplace_back(middle.array() - reach, middle.array() + reach);
  }
  const BoxTree tree(boxes);
  std::vector<std::uint8_t> wanted(is_seen_.size(), 0);
  tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t f) {
    if (is_seen_[f] != 0) return;
    const auto& [a, b, c] = mesh_.faces[f];
    BoxTree::Box box(mesh_.positions[a]);
    box.extend(mesh_.positions[b]).extend(mesh_.positions[c]);
    if (looks_ > kMostLooks) wanted[f] = 1;
    tree.visit_touching(box, [&](Index) { wanted[f] = 1; });
    is_seen_[f] = wanted[f];
  });
  FaceTriangles triangles{mesh_.faces, std::vector<Index>(mesh_.faces.size())};
  std::iota(triangles.face.begin(), triangles.face.end(), 0);
  std::set<Index> faces;
  for (const auto& pair : find_crossing_faces(mesh_.positions, triangles, wanted, {})) {
    faces.insert(pair.begin(), pair.end());
  }
  if (faces.empty()) return;
  own_.reset();  // which refers to them
  for (const Index f : faces) crossing_.push_back(mesh_.faces[f]);
  own_ = std::make_unique<SurfaceDistance>(mesh_.positions, crossing_);
}

bool CrossingPlaces::is_crossed_by_itself(const Place& place) const {
  return own_ != nullptr && own_->closest_within(place.middle, place.reach).triangle != kNone;
}

}  // namespace strake
