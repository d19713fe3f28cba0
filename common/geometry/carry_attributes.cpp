#include "common/geometry/carry_attributes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "common/geometry/surface_point.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// Finds the triangles in which the corners of a result lie.
class CornerPlaces {
 public:
  CornerPlaces(const TriMesh& mesh, const PolyMesh& result, const VertexProvenance& places)
      : mesh_(mesh), result_(result), places_(places) {}

  /// All triangles that the vertex belongs to.
  void find(Index vertex, std::vector<SurfacePoint>& found) const {
    const SurfacePoint own = foot_of(places_, vertex);
    found.clear();
    const Index corner = corner_at(own);
    if (corner != kNone) {
      for_each_outgoing(mesh_, mesh_.from(corner),
                        [&](Index h) { found.push_back(point_along(h, 0)); });
      return;
    }
    found.push_back(own);
    const Index inner = edge_at(own, [&](Index h) { return !mesh_.is_boundary(h); });
    if (inner == kNone) return;
    const Index twin = mesh_.twin[inner];
    SurfacePoint& other = found.emplace_back(SurfacePoint{TriMesh::face_of(twin), {0, 0, 0}});
    other.barycentric[twin % 3] = share_along(own, inner);
    other.barycentric[TriMesh::next(twin) % 3] = own.barycentric[inner % 3];
  }

  /// The one of these triangles on which corner number `i` of face `f` lies.
  [[nodiscard]] const SurfacePoint& choose(Index f, int i,
                                           const std::vector<SurfacePoint>& among) const {
    if (among.size() == 1) return among.front();
    const Vec3 inwards = bisector(result_.face(f), i);
    const auto score = [&](const SurfacePoint& place) { return support(place, inwards); };
    const SurfacePoint* best = &among.front();
    for (const SurfacePoint& place : among) {
      if (score(place) > score(*best)) best = &place;
    }
    return *best;
  }

 private:
  /// Direction from a corner into its face, halfway between its edges.
  [[nodiscard]] Vec3 bisector(std::span<const Index> face, int i) const {
    const int count = static_cast<int>(face.size());
    const auto at = [&](int k) -> const Vec3& { return result_.positions[face[k % count]]; };
    Vec3 normal = Vec3::Zero();
    for (int k = 1; k + 1 < count; ++k) normal += (at(k) - at(0)).cross(at(k + 1) - at(0));
    const Vec3 onward = (at(i + 1) - at(i)).stableNormalized();
    const Vec3 back = (at(i + count - 1) - at(i)).stableNormalized();
    return normal.stableNormalized().cross(onward - back).stableNormalized();
  }

  /// How far a unit direction from a point on a triangle's outline leads into the triangle, and not
  /// away from its plane: along an edge where three sides of a cube meet two are equally far in.
  [[nodiscard]] double support(const SurfacePoint& place, const Vec3& direction) const {
    const auto& corners = mesh_.faces[place.face];
    const auto at = [&](int k) -> const Vec3& { return mesh_.positions[corners[k % 3]]; };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).stableNormalized();
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      // Each side of the outline that the point lies on limits the way.
      if (!is_on_edge(place, 3 * place.face + i)) continue;
      const Vec3 side = (at(i + 1) - at(i)).stableNormalized();
      least = std::min(least, normal.cross(side).dot(direction));
    }
    return least - std::abs(normal.dot(direction));
  }

  const TriMesh& mesh_;
  const PolyMesh& result_;
  const VertexProvenance& places_;
};

template <std::size_t N>
void add_weighted(std::array<double, N>& sum, double weight, const std::array<double, N>& value) {
  for (std::size_t k = 0; k < N; ++k) sum[k] += weight * value[k];
}

/// What most votes are for; of equals what most further ones are for, and then the least.
template <class FurtherVotes>
Index most_frequent(const std::vector<Index>& votes, const FurtherVotes& further_votes) {
  std::map<Index, int> counts;
  for (const Index vote : votes) ++counts[vote];
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const int most = std::max_element(counts.begin(), counts.end(), fewer)->second;
  std::erase_if(counts, [&](const auto& label) { return label.second < most; });
  if (counts.size() > 1) {
    for (const Index vote : further_votes()) {
      if (const auto label = counts.find(vote); label != counts.end()) ++label->second;
    }
  }
  return std::max_element(counts.begin(), counts.end(), fewer)->first;
}

/// The triangle that a straight way along the surface from one leads to, towards the foot of a
/// point; the last one where it ends at a boundary, or turns back.
Index walk_towards(const TriMesh& mesh, Index face, const Vec3& p) {
  constexpr int kMostSteps = 1000;
  Index before = kNone;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto& [a, b, c] = mesh.faces[face];
    const std::array<Vec3, 3> at = {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
    const Vec3 normal = (at[1] - at[0]).cross(at[2] - at[0]);
    Index out = kNone;
    double least = 0;
    for (int i = 0; i < 3; ++i) {  // the side that the foot is farthest beyond, if any
      const double inside = normal.cross(at[(i + 1) % 3] - at[i]).stableNormalized().dot(p - at[i]);
      if (inside < least) {
        least = inside;
        out = 3 * face + i;
      }
    }
    if (out == kNone || mesh.twin[out] == kNone) return face;
    const Index next = TriMesh::face_of(mesh.twin[out]);
    if (next == before) return face;
    before = face;
    face = next;
  }
  return face;
}

/// Carries attributes of faces and their corners.
class FaceCarrier {
 public:
  FaceCarrier(const TriMesh& mesh, const PolyMesh& result, const VertexProvenance& places,
              Attributes& attributes)
      : mesh_(mesh),
        from_(mesh.attributes),
        to_(attributes),
        result_(result),
        places_(mesh, result, places) {
    for (const FaceLabels& labels : from_.labels) {
      to_.labels.push_back({labels.name, {}, labels.names});
    }
    sure_.resize(from_.labels.size());
    chosen_.resize(from_.labels.size());
  }

  void add(Index f) {
    for (auto* votes : {&sure_, &chosen_}) {
      for (std::vector<Index>& of_kind : *votes) of_kind.clear();
    }
    const auto face = result_.face(f);
    starts_.clear();
    for (int i = 0; i < static_cast<int>(face.size()); ++i) {
      places_.find(face[i], found_);
      const SurfacePoint& place = places_.choose(f, i, found_);
      starts_.push_back(place.face);
      if (!from_.texture.empty()) add_texture(place);
      for (std::size_t k = 0; k < from_.labels.size(); ++k) vote(k, place);
    }
    for (std::size_t k = 0; k < from_.labels.size(); ++k) {
      to_.labels[k].of_face.push_back(most_frequent(sure_[k].empty() ? chosen_[k] : sure_[k],
                                                    [&] { return labels_below(f, k); }));
    }
  }

 private:
  void add_texture(const SurfacePoint& place) {
    TexturePoint& point = to_.texture.emplace_back(TexturePoint{});
    for (int i = 0; i < 3; ++i) {
      add_weighted(point, place.barycentric[i], from_.texture[3 * place.face + i]);
    }
  }

  void vote(std::size_t kind, const SurfacePoint& place) {
    const std::vector<Index>& label = from_.labels[kind].of_face;
    const Index own = label[place.face];
    chosen_[kind].push_back(own);
    const bool is_sure = std::all_of(found_.begin(), found_.end(),
                                     [&](const SurfacePoint& p) { return label[p.face] == own; });
    if (is_sure) sure_[kind].push_back(own);
  }

  /// Labels below the middle of a face, found from each of its corners.
  [[nodiscard]] std::vector<Index> labels_below(Index f, std::size_t kind) const {
    const auto face = result_.face(f);
    Vec3 middle = -mesh_.origin;
    for (const Index v : face) middle += result_.positions[v] / static_cast<double>(face.size());
    std::vector<Index> labels;
    for (const Index start : starts_) {
      labels.push_back(from_.labels[kind].of_face[walk_towards(mesh_, start, middle)]);
    }
    return labels;
  }

  const TriMesh& mesh_;
  const Attributes& from_;
  Attributes& to_;
  const PolyMesh& result_;
  CornerPlaces places_;
  std::vector<SurfacePoint> found_;
  std::vector<Index> starts_;             ///< triangles of the corners of the present face
  std::vector<std::vector<Index>> sure_;  ///< votes for labels of each kind
  std::vector<std::vector<Index>> chosen_;
};

}  // namespace

Attributes carry_attributes(const TriMesh& mesh, const PolyMesh& result,
                            const VertexProvenance& places) {
  Attributes attributes;
  const Attributes& from = mesh.attributes;
  attributes.material_files = from.material_files;
  if (!from.colour.empty()) {
    for (Index v = 0; v < result.vertex_count(); ++v) {
      Colour& colour = attributes.colour.emplace_back(Colour{});
      for (int i = 0; i < 3; ++i) {
        add_weighted(colour, places.barycentric[v][i], from.colour[mesh.faces[places.face[v]][i]]);
      }
    }
  }
  if (from.texture.empty() && from.labels.empty()) return attributes;
  FaceCarrier faces(mesh, result, places, attributes);
  for (Index f = 0; f < result.face_count(); ++f) faces.add(f);
  return attributes;
}

}  // namespace strake
