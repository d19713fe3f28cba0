#include "common/geometry/poly_topology/poly_edges.h"

#include <algorithm>
#include <span>
#include <string>

#include "common/core/error.h"

namespace strake {
namespace {

/// One side of an edge, as seen from the edge's smaller vertex.
struct Use {
  Index larger;
  Index corner;
};

bool operator<(const Use& a, const Use& b) {
  return a.larger != b.larger ? a.larger < b.larger : a.corner < b.corner;
}

std::vector<Index> faces_of_corners(const PolyMesh& mesh) {
  std::vector<Index> face_of(mesh.corners.size());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (Index c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
      if (mesh.corners[c] < 0 || mesh.corners[c] >= mesh.vertex_count()) {
        throw PreconditionError("face " + std::to_string(f) + " names vertex " +
                                std::to_string(mesh.corners[c]) + ", but the mesh has " +
                                std::to_string(mesh.vertex_count()) + " vertices");
      }
      face_of[c] = f;
    }
  }
  return face_of;
}

}  // namespace

PolyEdges collect_edges(const PolyMesh& mesh) {
  PolyEdges edges;
  edges.corner_face = faces_of_corners(mesh);
  const auto corner_count = static_cast<Index>(mesh.corners.size());

  // Sides grouped by their smaller vertex, in order of corners; each group is then sorted.
  std::vector<Index> group(mesh.positions.size() + 1, 0);
  const auto ends = [&](Index c) {
    return std::minmax(mesh.corners[c], mesh.corners[next_corner(mesh, edges, c)]);
  };
  for (Index c = 0; c < corner_count; ++c) {
    const auto [a, b] = ends(c);
    if (a != b) ++group[a + 1];
  }
  for (std::size_t v = 1; v < group.size(); ++v) group[v] += group[v - 1];
  std::vector<Use> uses(static_cast<std::size_t>(group.back()));
  std::vector<Index> fill(group.begin(), group.end() - 1);
  for (Index c = 0; c < corner_count; ++c) {
    const auto [a, b] = ends(c);
    if (a != b) uses[fill[a]++] = {b, c};
  }

  edges.sides.reserve(uses.size());
  edges.vertices.reserve(uses.size() / 2 + 1);
  edges.side_offsets.reserve(uses.size() / 2 + 2);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    std::sort(uses.begin() + group[v], uses.begin() + group[v + 1]);
    for (Index i = group[v]; i < group[v + 1]; ++i) {
      if (i == group[v] || uses[i].larger != uses[i - 1].larger) {
        edges.vertices.push_back({v, uses[i].larger});
        edges.side_offsets.push_back(edges.side_offsets.back());
      }
      edges.sides.push_back(uses[i].corner);
      ++edges.side_offsets.back();
    }
  }
  return edges;
}

std::vector<Index> opposite_sides(const PolyEdges& edges) {
  std::vector<Index> opposite(edges.corner_face.size(), kNone);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const std::span<const Index> sides = edges.sides_of(e);
    if (sides.size() != 2) continue;
    opposite[sides[0]] = sides[1];
    opposite[sides[1]] = sides[0];
  }
  return opposite;
}

}  // namespace strake
