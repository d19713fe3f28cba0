#include "stages/import/listed_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <set>

#include "common/core/disjoint_sets.h"
#include "common/core/error.h"
#include "stages/import/feature_graph.h"

namespace strake::import {
namespace {

[[noreturn]] void refuse(const EdgeList& list, const EdgeList::Edge& edge,
                         const std::string& what) {
  throw InputError(fmt::format("'{}', line {}: {}", list.name, edge.line, what));
}

void require_vertices(const EdgeList& list, const PolyMesh& input) {
  for (const EdgeList::Edge& edge : list.edges) {
    for (const Index v : {edge.from, edge.to}) {
      if (v < 0 || v >= input.vertex_count()) {
        refuse(list, edge,
               fmt::format("there is no vertex {}, the mesh has {}; numbers count from 0 in the "
                           "order of the mesh file",
                           v, input.vertex_count()));
      }
      if (!input.positions[v].allFinite()) {
        refuse(list, edge, fmt::format("vertex {} lies nowhere; leave it out", v));
      }
    }
  }
}

/// [V] The lowest of the vertices at the same place, and of those that were joined with them.
std::vector<Index> numbers_of(const PolyMesh& input, const std::vector<JoinedVertex>& joined) {
  std::vector<Index> order;  // what is no number equals everything
  for (Index v = 0; v < input.vertex_count(); ++v) {
    if (input.positions[v].allFinite()) order.push_back(v);
  }
  const auto place = [&](Index v) {
    const Vec3& p = input.positions[v];
    return std::array<double, 3>{p.x(), p.y(), p.z()};
  };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return place(a) < place(b); });
  DisjointSets same(input.vertex_count());
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (place(order[i - 1]) == place(order[i])) same.unite(order[i - 1], order[i]);
  }
  for (const JoinedVertex& vertex : joined) same.unite(vertex.gone, vertex.kept);
  std::vector<Index> numbers(input.positions.size());
  for (Index v = 0; v < input.vertex_count(); ++v) numbers[v] = same.find(v);
  return numbers;
}

}  // namespace

ListedEdges::ListedEdges(const EdgeList& list, const PolyMesh& input, const Soup& soup)
    : list_(list) {
  require_vertices(list, input);
  number_ = numbers_of(input, soup.joined);
  for (const std::vector<DividedEdge>& round : soup.divided) divide(round);
}

void ListedEdges::divide(const std::vector<DividedEdge>& divided) {
  std::map<Ends, const DividedEdge*> by_ends;
  for (const DividedEdge& edge : divided) {
    if (edge.from == kNone || edge.to == kNone || std::ranges::count(edge.inside, kNone) > 0) {
      continue;
    }
    by_ends[ends_of(edge.from, edge.to)] = &edge;
  }
  std::vector<EdgeList::Edge> parts;
  for (const EdgeList::Edge& edge : list_.edges) {
    const auto found = by_ends.find(ends_of(edge.from, edge.to));
    std::vector<Index> inside;
    if (found != by_ends.end()) inside = found->second->inside;
    const bool is_reversed = !inside.empty() && number_[found->second->from] != number_[edge.from];
    if (is_reversed) std::reverse(inside.begin(), inside.end());
    Index from = edge.from;
    for (const Index v : inside) {
      parts.push_back({from, v, edge.line});
      from = v;
    }
    parts.push_back({from, edge.to, edge.line});
  }
  list_.edges = std::move(parts);
}

Index ListedEdges::flag(TriMesh& mesh) const {
  std::map<Ends, bool> found;
  std::set<Index> numbers;
  for (const EdgeList::Edge& edge : list_.edges) {
    const Ends ends = ends_of(edge.from, edge.to);
    found[ends] = false;
    numbers.insert({ends.first, ends.second});
  }
  std::vector<std::uint8_t> is_end(mesh.positions.size(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Index source = mesh.source_vertex[v];
    is_end[v] = source != kNone && numbers.contains(number_[source]) ? 1 : 0;
  }
  Index count = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.edge_of(h) != h || is_end[mesh.from(h)] == 0 || is_end[mesh.to(h)] == 0) continue;
    const auto listed =
        found.find(ends_of(mesh.source_vertex[mesh.from(h)], mesh.source_vertex[mesh.to(h)]));
    if (listed == found.end()) continue;
    listed->second = true;
    if (mesh.is_boundary(h)) continue;  // kept anyway
    set_feature(mesh, h, true);
    ++count;
  }
  for (const EdgeList::Edge& edge : list_.edges) {
    if (found.at(ends_of(edge.from, edge.to))) continue;
    refuse(
        list_, edge,
        fmt::format("no edge joins vertices {} and {}, or repairs have removed it; list vertices "
                    "that are neighbours",
                    edge.from, edge.to));
  }
  return count;
}

}  // namespace strake::import
