#include "stages/import/listed_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "common/core/error.h"
#include "stages/import/feature_graph.h"

namespace strake::import {
namespace {

using Place = std::array<double, 3>;

Place place_of(const PolyMesh& input, Index vertex) {
  const Vec3& p = input.positions[vertex];
  return {p.x(), p.y(), p.z()};
}

using Ends = std::pair<Place, Place>;

Ends ends_at(const Place& a, const Place& b) { return std::minmax(a, b); }

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
      // Places are compared below, and what is no number equals everything.
      if (!input.positions[v].allFinite()) {
        refuse(list, edge, fmt::format("vertex {} lies nowhere; leave it out", v));
      }
    }
  }
}

std::vector<Index> vertices_of(const DividedEdge& edge) {
  std::vector<Index> vertices = {edge.from};
  vertices.insert(vertices.end(), edge.inside.begin(), edge.inside.end());
  vertices.push_back(edge.to);
  return vertices;
}

/// Those from the end at a place to the other.
std::vector<Index> along(const DividedEdge& edge, const Place& from, const PolyMesh& input) {
  std::vector<Index> vertices = vertices_of(edge);
  if (place_of(input, edge.from) != from) std::reverse(vertices.begin(), vertices.end());
  return vertices;
}

}  // namespace

EdgeList listed_parts(const EdgeList& list, const PolyMesh& input,
                      const std::vector<DividedEdge>& divided) {
  std::map<Ends, const DividedEdge*> by_ends;
  for (const DividedEdge& edge : divided) {
    const std::vector<Index> vertices = vertices_of(edge);
    if (std::count(vertices.begin(), vertices.end(), kNone) > 0) continue;
    by_ends[ends_at(place_of(input, edge.from), place_of(input, edge.to))] = &edge;
  }
  require_vertices(list, input);
  EdgeList parts{{}, list.name};
  for (const EdgeList::Edge& edge : list.edges) {
    const Place from = place_of(input, edge.from);
    const auto found = by_ends.find(ends_at(from, place_of(input, edge.to)));
    if (found == by_ends.end()) {
      parts.edges.push_back(edge);
      continue;
    }
    const std::vector<Index> vertices = along(*found->second, from, input);
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      parts.edges.push_back({vertices[i - 1], vertices[i], edge.line});
    }
  }
  return parts;
}

Index flag_listed_edges(const EdgeList& list, const PolyMesh& input, TriMesh& mesh) {
  require_vertices(list, input);
  std::map<Ends, bool> found;  // listed edges by the places of their ends
  std::set<Place> places;
  for (const EdgeList::Edge& edge : list.edges) {
    const Place a = place_of(input, edge.from);
    const Place b = place_of(input, edge.to);
    found[ends_at(a, b)] = false;
    places.insert({a, b});
  }
  std::vector<std::uint8_t> is_end(mesh.positions.size(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Index source = mesh.source_vertex[v];
    is_end[v] = source != kNone && places.contains(place_of(input, source)) ? 1 : 0;
  }
  Index count = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.edge_of(h) != h || is_end[mesh.from(h)] == 0 || is_end[mesh.to(h)] == 0) continue;
    const auto listed = found.find(ends_at(place_of(input, mesh.source_vertex[mesh.from(h)]),
                                           place_of(input, mesh.source_vertex[mesh.to(h)])));
    if (listed == found.end()) continue;
    listed->second = true;
    if (mesh.is_boundary(h)) continue;  // kept anyway
    set_feature(mesh, h, true);
    ++count;
  }
  for (const EdgeList::Edge& edge : list.edges) {
    if (found.at(ends_at(place_of(input, edge.from), place_of(input, edge.to)))) continue;
    refuse(
        list, edge,
        fmt::format("no edge joins vertices {} and {}, or repairs have removed it; list vertices "
                    "that are neighbours",
                    edge.from, edge.to));
  }
  return count;
}

}  // namespace strake::import
