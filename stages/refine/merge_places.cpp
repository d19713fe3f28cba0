#include "stages/refine/merge_places.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "common/geometry/patch_fill/drop_unused_vertices.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/vertex_faces.h"

namespace strake {
namespace {

/// Distance, in longest sides of a face, up to which its corners are at the same place.
constexpr double kSamePlace = 1e-9;
/// Times that vertices not near each other are merged.
constexpr int kMostRounds = 10;
/// Faces around a vertex that may lose one.
constexpr std::size_t kLeastFaces = 4;

class Merging {
 public:
  explicit Merging(const PolyMesh& mesh)
      : mesh_(mesh),
        around_(mesh),
        is_rim_(mesh.positions.size(), 0),
        is_near_(mesh.positions.size(), 0) {
    const PolyEdges edges = collect_edges(mesh);
    for (Index e = 0; e < edges.edge_count(); ++e) {
      if (edges.sides_of(e).size() > 1) continue;
      for (const Index v : edges.vertices[e]) is_rim_[v] = 1;
    }
  }

  /// [V] the vertex that takes the place of each: itself for most, else one on the boundary or an
  /// older one, which has the lines that it was made from.
  std::vector<Index> merged() {
    std::vector<Index> instead(mesh_.positions.size());
    std::iota(instead.begin(), instead.end(), 0);
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      for (const auto& [u, w] : in_one_place(f)) {
        if (!may_merge(u, w)) continue;
        // One on the boundary has its point there.
        const Index stays = is_rim_[u] != 0 ? u : is_rim_[w] != 0 ? w : std::min(u, w);
        instead[u + w - stays] = stays;
        for (const Index v : {u, w}) {
          is_near_[v] = 1;
          for (const Index n : around_.neighbours(v)) is_near_[n] = 1;
        }
      }
    }
    return instead;
  }

 private:
  /// Corners of a face at the same place, that a side joins or a quad has opposite each other.
  [[nodiscard]] std::vector<std::array<Index, 2>> in_one_place(Index f) const {
    const std::span<const Index> face = mesh_.face(f);
    const std::size_t n = face.size();
    const auto distance = [&](std::size_t i, std::size_t j) {
      return (mesh_.positions[face[i]] - mesh_.positions[face[j % n]]).norm();
    };
    double longest = 0;
    for (std::size_t i = 0; i < n; ++i) longest = std::max(longest, distance(i, i + 1));
    std::vector<std::array<Index, 2>> pairs;
    const auto note = [&](std::size_t i, std::size_t j) {
      if (distance(i, j) <= kSamePlace * longest) pairs.push_back({face[i], face[j % n]});
    };
    for (std::size_t i = 0; i < n; ++i) note(i, i + 1);
    for (std::size_t i = 0; n == 4 && i < 2; ++i) note(i, i + 2);
    return pairs;
  }

  /// The link condition: what both have in common is only what goes with the faces between them.
  [[nodiscard]] bool may_merge(Index u, Index w) const {
    if (is_near_[u] != 0 || is_near_[w] != 0) return false;
    const std::vector<Index> of_u = around_.neighbours(u);
    const std::vector<Index> of_w = around_.neighbours(w);
    const bool are_joined = std::ranges::binary_search(of_u, w);
    const int rims = is_rim_[u] + is_rim_[w];
    if (rims > (are_joined ? 1 : 0)) return false;
    std::vector<Index> in_common;
    std::ranges::set_intersection(of_u, of_w, std::back_inserter(in_common));
    std::vector<Index> go_between;
    std::size_t between = 0;
    for (const Index f : around_.faces(u)) {
      const std::span<const Index> face = mesh_.face(f);
      if (std::ranges::find(face, w) == face.end()) continue;
      ++between;
      if (are_joined && face.size() > 3) continue;
      if (!are_joined && face.size() != 4) return false;
      for (const Index v : face) {
        if (v != u && v != w) go_between.push_back(v);
      }
    }
    std::ranges::sort(go_between);
    const auto has_enough = [&](Index v) {
      return is_near_[v] == 0 && around_.faces(v).size() >= kLeastFaces;
    };
    return between == (are_joined ? 2U : 1U) && in_common == go_between &&
           std::ranges::all_of(go_between, has_enough);
  }

  const PolyMesh& mesh_;
  VertexFaces around_;
  std::vector<char> is_rim_;   ///< [V] 1: on the boundary
  std::vector<char> is_near_;  ///< [V] 1: merged, or beside one that is, so its faces are others
};

/// A face without repeated corners; nothing where it is folded onto itself.
std::vector<Index> without_repeats(std::span<const Index> face, const std::vector<Index>& instead) {
  std::vector<Index> corners;
  for (const Index v : face) {
    if (corners.empty() || corners.back() != instead[v]) corners.push_back(instead[v]);
  }
  while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  const bool is_folded =
      corners.size() == 4 && (corners[0] == corners[2] || corners[1] == corners[3]);
  return corners.size() < 3 || is_folded ? std::vector<Index>{} : corners;
}

}  // namespace

Index merge_places(QuadMesh& quads) {
  const Index before = quads.mesh.vertex_count();
  for (int i = 0; i < kMostRounds; ++i) {
    const std::vector<Index> instead = Merging(quads.mesh).merged();
    PolyMesh merged;
    for (Index f = 0; f < quads.mesh.face_count(); ++f) {
      const std::vector<Index> corners = without_repeats(quads.mesh.face(f), instead);
      if (!corners.empty()) merged.add_face(corners);
    }
    if (merged.corners == quads.mesh.corners) break;
    quads.mesh.corners = std::move(merged.corners);
    quads.mesh.offsets = std::move(merged.offsets);
    drop_unused_vertices(quads);
  }
  return before - quads.mesh.vertex_count();
}

}  // namespace strake
