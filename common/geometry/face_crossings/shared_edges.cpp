#include "common/geometry/face_crossings/shared_edges.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/geometry/segment.h"

namespace strake {
namespace {

/// [V] the first vertex at the same place.
std::vector<Index> first_at_place(const std::vector<Vec3>& positions) {
  std::vector<Index> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index v) {
    const Vec3& p = positions[v];
    return std::array{p.x(), p.y(), p.z()};
  };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<Index> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_copy = i > 0 && positions[order[i]] == positions[order[i - 1]];
    first[order[i]] = is_copy ? first[order[i - 1]] : order[i];
  }
  return first;
}

std::vector<std::array<Vec3, 2>> edges_in_one_place(const TriMesh& mesh) {
  const std::vector<Index> first = first_at_place(mesh.positions);
  std::vector<char> has_copies(mesh.positions.size(), 0);
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (first[v] != static_cast<Index>(v)) has_copies[first[v]] = 1;
  }
  /// Where an edge is, and its vertices.
  using Edge = std::array<Index, 4>;
  std::vector<Edge> edges;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index a = mesh.from(h);
    const Index b = mesh.to(h);
    // One of the ends may be one vertex.
    if (has_copies[first[a]] == 0 && has_copies[first[b]] == 0) continue;
    edges.push_back(first[a] < first[b] ? Edge{first[a], first[b], a, b}
                                        : Edge{first[b], first[a], b, a});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::array<Vec3, 2>> shared;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const auto& [a, b, from, to] = edges[i];
    const bool is_copy = edges[i - 1][0] == a && edges[i - 1][1] == b;
    if (is_copy) shared.push_back({mesh.positions[a], mesh.positions[b]});
  }
  return shared;
}

std::vector<BoxTree::Box> boxes_of(const std::vector<std::array<Vec3, 2>>& segments) {
  std::vector<BoxTree::Box> boxes;
  for (const auto& [a, b] : segments) boxes.push_back(BoxTree::Box(a).extend(b));
  return boxes;
}

}  // namespace

SharedEdges::SharedEdges(const TriMesh& mesh, double within)
    : within_(within), ends_(edges_in_one_place(mesh)), tree_(boxes_of(ends_)) {}

bool SharedEdges::hold(const Vec3& p) const {
  bool is_on = false;
  tree_.visit_touching({p.array() - within_, p.array() + within_}, [&](Index i) {
    is_on = is_on || way_to_segment(p, ends_[i][0], ends_[i][1]).norm() <= within_;
  });
  return is_on;
}

bool SharedEdges::are_near(const BoxTree::Box& box) const {
  bool is_near = false;
  tree_.visit_touching({box.min().array() - within_, box.max().array() + within_},
                       [&](Index) { is_near = true; });
  return is_near;
}

}  // namespace strake
