#include "stages/import/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/core/mix_bits.h"
#include "stages/import/gaps.h"

namespace strake::import {
namespace {

std::vector<Index> border_halfedges(const Soup& soup, Index& edges) {
  const EdgeGroups groups(soup);
  edges = groups.size();
  std::vector<Index> border;
  for (Index g = 0; g < groups.size(); ++g) {
    if (groups[g].size() == 1) border.push_back(groups[g][0]);
  }
  return border;
}

/// Finds points within a tolerance of each other, by a grid of cells of twice that size: a point
/// and its partners lie in the cells that the tolerance box around it touches.
class PointClusters {
 public:
  PointClusters(const Soup& soup, const std::vector<Index>& vertices, double tolerance)
      : soup_(soup), tolerance_(tolerance), sets_(soup.vertex_count()) {
    cells_.reserve(vertices.size());
    for (const Index v : vertices) add(v);
  }
  Index cluster_of(Index vertex) { return sets_.find(vertex); }

 private:
  void add(Index v) {
    const Vec3& p = soup_.positions[v];
    std::array<std::int64_t, 3> low;
    std::array<std::int64_t, 3> high;
    for (int i = 0; i < 3; ++i) {
      low[i] = cell_of(p[i] - tolerance_);
      high[i] = cell_of(p[i] + tolerance_);
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) join(v, key_of(x, y, z));
      }
    }
    // Points of a cell are chained, the newest first.
    Index& head = cells_.try_emplace(key_of(cell_of(p.x()), cell_of(p.y()), cell_of(p.z())), kNone)
                      .first->second;
    chain_.emplace_back(v, head);
    head = static_cast<Index>(chain_.size()) - 1;
  }

  void join(Index v, std::uint64_t key) {
    const auto cell = cells_.find(key);
    if (cell == cells_.end()) return;
    for (Index i = cell->second; i != kNone; i = chain_[i].second) {
      const Index other = chain_[i].first;
      if ((soup_.positions[other] - soup_.positions[v]).norm() > tolerance_) continue;
      sets_.unite(other, v);
      // `other` has been united already with whatever is close to the place it shares with v.
      if (soup_.positions[other] == soup_.positions[v]) return;
    }
  }

  [[nodiscard]] std::int64_t cell_of(double coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / (2 * tolerance_)));
  }
  static std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint64_t key = 0;
    for (const std::int64_t c : {x, y, z}) key = mix_bits(key, static_cast<std::uint64_t>(c));
    return key;
  }

  const Soup& soup_;
  double tolerance_;
  DisjointSets sets_;
  std::unordered_map<std::uint64_t, Index> cells_;
  std::vector<std::pair<Index, Index>> chain_;
};

/// A border edge by the clusters of its ends.
struct ClusterEdge {
  Index low;
  Index high;
  Index halfedge;
};

std::vector<ClusterEdge> cluster_edges(const Soup& soup, const std::vector<Index>& border,
                                       PointClusters& clusters) {
  std::vector<ClusterEdge> edges;
  edges.reserve(border.size());
  for (const Index h : border) {
    const auto [low, high] =
        std::minmax({clusters.cluster_of(soup.from(h)), clusters.cluster_of(soup.to(h))});
    edges.push_back({low, high, h});
  }
  std::sort(edges.begin(), edges.end(), [](const ClusterEdge& a, const ClusterEdge& b) {
    return std::tie(a.low, a.high, a.halfedge) < std::tie(b.low, b.high, b.halfedge);
  });
  return edges;
}

void unite_edges(const Soup& soup, const ClusterEdge& a, const ClusterEdge& b,
                 PointClusters& clusters, DisjointSets& joined) {
  const auto end_in = [&](const ClusterEdge& edge, Index cluster) {
    const Index from = soup.from(edge.halfedge);
    return clusters.cluster_of(from) == cluster ? from : soup.to(edge.halfedge);
  };
  joined.unite(end_in(a, a.low), end_in(b, a.low));
  joined.unite(end_in(a, a.high), end_in(b, a.high));
}

}  // namespace

std::int64_t rename_vertices(Soup& soup, DisjointSets& joined, double& farthest) {
  std::int64_t gone = 0;
  double largest = 0;
  for (Index v = 0; v < soup.vertex_count(); ++v) {
    const Index kept = joined.find(v);
    if (kept == v) continue;
    ++gone;
    const bool are_apart = soup.positions[v] != soup.positions[kept];
    if (are_apart && soup.source_vertex[v] != kNone && soup.source_vertex[kept] != kNone) {
      soup.joined.push_back({soup.source_vertex[v], soup.source_vertex[kept]});
    }
    largest = std::max(largest, (soup.positions[v] - soup.positions[kept]).norm());
  }
  farthest += largest;
  if (gone == 0) return 0;
  for (Triangle& face : soup.faces) {
    for (Index& v : face) v = joined.find(v);
  }
  return gone;
}

std::vector<Index> without_joined(const Soup& soup, const std::vector<Index>& border) {
  using Edge = std::array<Index, 3>;  // lower and higher vertex, half-edge
  std::vector<Edge> edges;
  edges.reserve(border.size());
  for (const Index h : border) {
    const auto [low, high] = std::minmax({soup.from(h), soup.to(h)});
    if (low != high) edges.push_back({low, high, h});
  }
  std::sort(edges.begin(), edges.end());
  const auto is_same = [&](std::size_t i, std::size_t j) {
    return edges[i][0] == edges[j][0] && edges[i][1] == edges[j][1];
  };
  std::vector<Index> left;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool is_single =
        (i == 0 || !is_same(i - 1, i)) && (i + 1 == edges.size() || !is_same(i, i + 1));
    if (is_single) left.push_back(edges[i][2]);
  }
  std::sort(left.begin(), left.end());
  return left;
}

std::vector<Index> find_borders(const Soup& soup) {
  Index ignored = 0;
  return without_joined(soup, border_halfedges(soup, ignored));
}

std::vector<Index> weld_borders(Soup& soup, double diagonal, Repairs& repairs) {
  Index edge_count = 0;
  const std::vector<Index> border = border_halfedges(soup, edge_count);
  if (border.empty()) return border;
  const bool is_unwelded = 2 * border.size() > static_cast<std::size_t>(edge_count);
  const double tolerance = (is_unwelded ? kRounding : kCoincident) * diagonal;

  std::vector<Index> vertices;
  for (const Index h : border) vertices.insert(vertices.end(), {soup.from(h), soup.to(h)});
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  PointClusters clusters(soup, vertices, tolerance);
  const std::vector<ClusterEdge> edges = cluster_edges(soup, border, clusters);

  DisjointSets joined(soup.vertex_count());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].low == edges[i].high) {
      joined.unite(soup.from(edges[i].halfedge), soup.to(edges[i].halfedge));
    } else if (i > 0 && edges[i].low == edges[i - 1].low && edges[i].high == edges[i - 1].high) {
      unite_edges(soup, edges[i - 1], edges[i], clusters, joined);
    }
  }
  repairs.welded_vertices = rename_vertices(soup, joined, repairs.farthest_moved);
  if (repairs.welded_vertices > 0) repairs.weld_tolerance = tolerance;
  return without_joined(soup, border);
}

}  // namespace strake::import
