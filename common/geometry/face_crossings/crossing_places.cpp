#include "common/geometry/face_crossings/crossing_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/face_crossings/penetration.h"
#include "common/geometry/face_crossings/placed_face.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {
namespace {

/// Times to look into boxes around places, before all of the input is looked at: it takes a tenth
/// of the time and memory.
constexpr std::size_t kMostLooks = 8;
/// Half the side of such a box over the reach of its place: faces that are asked for later are
/// often smaller, and beside it.
constexpr double kLookedInto = 3;
/// Where two sheets cross there are about as many pairs of faces that do as faces. With twice as
/// many, and many times as many pairs as of the input and a few more, cells are tangled.
constexpr std::size_t kPairsPerFace = 2;
constexpr std::size_t kMostPairs = 3;
constexpr std::size_t kFewPairs = 10;
/// Share of the diagonal within which something is on an edge that sheets of the input share: what
/// files of single precision leave of a common edge is less, and nobody sees it.
constexpr double kOnEdge = 1e-6;
/// Share of an edge along those up to which faces touch that pass through each other: chords of a
/// curve that is divided differently in two sheets are apart by as much where cells turn by a
/// radian. Elsewhere what touches is tangled, as where lines are farther apart than a rod is thick.
constexpr double kTouchingShare = 0.125;

BoxTree::Box box_around(const Vec3& middle, double half) {
  return {middle.array() - half, middle.array() + half};
}

BoxTree::Box box_of(const TriMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  BoxTree::Box box(mesh.positions[a]);
  return box.extend(mesh.positions[b]).extend(mesh.positions[c]);
}

bool touches(const BoxTree& tree, const BoxTree::Box& box) {
  bool is_touched = false;
  tree.visit_touching(box, [&](Index) { is_touched = true; });
  return is_touched;
}

/// The faces for which is_wanted(face, box around it) holds, ascending; it is asked in parallel.
template <class Wanted>
std::vector<Index> faces_where(const TriMesh& mesh, const Wanted& is_wanted) {
  std::vector<std::uint8_t> flags(mesh.faces.size());
  tbb::parallel_for(Index{0}, mesh.face_count(),
                    [&](Index f) { flags[f] = is_wanted(f, box_of(mesh, f)) ? 1 : 0; });
  std::vector<Index> faces;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (flags[f] != 0) faces.push_back(f);
  }
  return faces;
}

}  // namespace

CrossingPlaces::Place CrossingPlaces::place_of(const PolyMesh& result, Index face) const {
  const std::span<const Index> corners = result.face(face);
  Vec3 middle = Vec3::Zero();
  for (const Index v : corners) middle += result.positions[v] / static_cast<double>(corners.size());
  double reach = 0;
  for (const Index v : corners) reach = std::max(reach, (result.positions[v] - middle).norm());
  return {middle - mesh_.origin, reach};
}

MeetingFaces CrossingPlaces::meeting(const PolyMesh& result) {
  const auto pairs = find_crossing_faces(result.positions, triangulate_faces(result));
  is_stacked_ = pairs.size() > static_cast<std::size_t>(result.face_count());
  std::set<Index> crossed;
  for (const auto& pair : pairs) crossed.insert(pair.begin(), pair.end());
  const std::vector<Index> faces(crossed.begin(), crossed.end());
  std::vector<Place> places;
  for (const Index f : faces) places.push_back(place_of(result, f));
  look_around(places);
  // Once for each face: one of many sheets in one place is in as many pairs.
  std::vector<std::uint8_t> is_own(static_cast<std::size_t>(result.face_count()), 0);
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
    is_own[faces[i]] = is_crossed_by_itself(places[i]) ? 1 : 0;
  });
  if (tangles_ == Tangles::kFaults) {
    for (const Cluster& cluster : clusters_of(pairs, faces, is_own)) {
      if (!is_tangled(cluster, places)) continue;
      for (const std::size_t i : cluster.faces) is_own[faces[i]] = 0;
    }
  }
  std::set<Index> met;
  crossed.clear();
  for (const auto& pair : pairs) {
    if (std::ranges::any_of(pair, [&](Index f) { return is_own[f] != 0; })) continue;
    met.insert(pair.begin(), pair.end());
    if (std::ranges::all_of(pair, [&](Index f) { return crossed.contains(f); })) continue;
    if (!do_touch(result, pair[0], pair[1])) crossed.insert(pair.begin(), pair.end());
  }
  return {{met.begin(), met.end()}, {crossed.begin(), crossed.end()}};
}

std::vector<CrossingPlaces::Cluster> CrossingPlaces::clusters_of(
    const std::vector<std::array<Index, 2>>& pairs, const std::vector<Index>& faces,
    const std::vector<std::uint8_t>& is_own) {
  DisjointSets sets(static_cast<Index>(is_own.size()));
  std::vector<Index> of_pairs;  // a face of each
  for (const auto& pair : pairs) {
    if (is_own[pair[0]] == 0 && is_own[pair[1]] == 0) continue;
    sets.unite(pair[0], pair[1]);
    of_pairs.push_back(pair[0]);
  }
  std::map<Index, Cluster> clusters;
  for (const Index f : of_pairs) ++clusters[sets.find(f)].pairs;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto at = clusters.find(sets.find(faces[i]));
    if (at != clusters.end()) at->second.faces.push_back(i);
  }
  std::vector<Cluster> result;
  for (auto& entry : clusters) result.push_back(std::move(entry.second));
  return result;
}

bool CrossingPlaces::is_tangled(const Cluster& cluster, const std::vector<Place>& places) const {
  if (cluster.pairs < kPairsPerFace * cluster.faces.size()) return false;
  // So many pairs of the input account for those of the result.
  const std::size_t enough = (cluster.pairs - std::min(cluster.pairs, kFewPairs)) / kMostPairs;
  std::set<Index> own;
  for (const std::size_t i : cluster.faces) {
    if (own.size() >= enough) return false;
    visit_crossings(places[i], [&](Index k) {
      own.insert(k);
      return own.size() < enough;
    });
  }
  return own.size() < enough;
}

std::vector<Vec3> CrossingPlaces::middles(const PolyMesh& result,
                                          const std::vector<Index>& faces) const {
  std::vector<Vec3> places;
  for (const Index f : faces) places.push_back(place_of(result, f).middle);
  return places;
}

bool CrossingPlaces::is_looked_at(const Place& place) const {
  bool is_within = looks_.size() > kMostLooks;
  const BoxTree::Box box = box_around(place.middle, place.reach);
  for (const Look& look : looks_) {
    look.tree.visit_touching(
        box, [&](Index i) { is_within = is_within || look.boxes[i].contains(box); });
  }
  return is_within;
}

void CrossingPlaces::look_around(const std::vector<Place>& places) {
  std::vector<BoxTree::Box> boxes;
  for (const Place& place : places) {
    if (!is_looked_at(place)) boxes.push_back(box_around(place.middle, kLookedInto * place.reach));
  }
  if (boxes.empty()) return;
  looks_.push_back({boxes, BoxTree(boxes)});
  is_seen_.resize(mesh_.faces.size(), 0);
  const bool is_everywhere = looks_.size() > kMostLooks;
  const std::vector<Index> wanted = faces_where(mesh_, [&](Index f, const BoxTree::Box& box) {
    return is_seen_[f] == 0 && (is_everywhere || touches(looks_.back().tree, box));
  });
  boxes.clear();
  for (const Index f : wanted) {
    is_seen_[f] = 1;
    boxes.push_back(box_of(mesh_, f));
  }
  const BoxTree tree(boxes);
  const std::vector<Index> near =
      faces_where(mesh_, [&](Index, const BoxTree::Box& box) { return touches(tree, box); });
  FaceTriangles triangles;
  std::vector<std::uint8_t> is_wanted(near.size());
  for (Index i = 0; i < static_cast<Index>(near.size()); ++i) {
    triangles.corners.push_back(mesh_.faces[near[i]]);
    triangles.face.push_back(i);
    is_wanted[i] = std::ranges::binary_search(wanted, near[i]) ? 1 : 0;
  }
  for (const auto& [i, j] : find_crossing_faces(mesh_.positions, triangles, is_wanted, {})) {
    crossing_.push_back({near[i], near[j]});
  }
  boxes.clear();
  for (const auto& [f, g] : crossing_) boxes.push_back(box_of(mesh_, f).merged(box_of(mesh_, g)));
  own_ = BoxTree(boxes);
}

template <class Visit>
void CrossingPlaces::visit_crossings(const Place& place, Visit visit) const {
  const auto is_within_reach = [&](Index f) {
    const auto& [a, b, c] = mesh_.faces[f];
    return closest_point_on_triangle(place.middle, mesh_.positions[a], mesh_.positions[b],
                                     mesh_.positions[c])
               .distance <= place.reach;
  };
  own_.visit_touching_while(box_around(place.middle, place.reach), [&](Index i) {
    return std::ranges::none_of(crossing_[i], is_within_reach) || visit(i);
  });
}

bool CrossingPlaces::is_crossed_by_itself(const Place& place) const {
  bool is_crossed = false;
  visit_crossings(place, [&](Index) {
    is_crossed = true;
    return false;
  });
  return is_crossed;
}

bool CrossingPlaces::do_touch(const PolyMesh& result, Index face, Index other) {
  if (!shared_) shared_ = std::make_unique<SharedEdges>(mesh_, kOnEdge * mesh_.diagonal);
  if (!shared_->any()) return false;
  const PlacedFace one = placed_face(result.positions, result.face(face));
  const PlacedFace two = placed_face(result.positions, result.face(other));
  const double depth = penetration_depth(one, two);
  const BoxTree::Box common = one.box.intersection(two.box).translated(-mesh_.origin);
  if (depth <= kOnEdge * mesh_.diagonal && shared_->are_near(common)) return true;
  return touches_along_shared(result, face, two, depth) ||
         touches_along_shared(result, other, one, depth);
}

bool CrossingPlaces::touches_along_shared(const PolyMesh& result, Index face,
                                          const PlacedFace& other, double depth) const {
  const std::span<const Index> corners = result.face(face);
  const auto is_on = [&](const Vec3& p) { return shared_->hold(p - mesh_.origin); };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& a = result.positions[corners[i]];
    const Vec3& b = result.positions[corners[(i + 1) % corners.size()]];
    const double most = kTouchingShare * (b - a).norm();
    const BoxTree::Box edge = BoxTree::Box(a).extend(b);
    const BoxTree::Box reach(edge.min().array() - most, edge.max().array() + most);
    if (depth <= most && other.box.intersects(reach) && is_on(a) && is_on(b)) return true;
  }
  return false;
}

}  // namespace strake
