#include "stages/import/corner_facets.h"

#include <algorithm>

#include "common/core/disjoint_sets.h"
#include "common/geometry/angles.h"

namespace strake::import {
namespace {

constexpr double kFlatBend = 1 * kDegree;  ///< largest bend within a facet
constexpr Index kFewestCreases = 2;        ///< at each corner of a facet

/// Number of edges that are bent by more than an angle at each vertex. [V]
std::vector<Index> bent_degrees(const TriMesh& mesh, const std::vector<float>& bend, double angle) {
  std::vector<Index> degree(mesh.positions.size(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (h > mesh.twin[h] || bend[h] <= angle) continue;
    ++degree[mesh.from(h)];
    ++degree[mesh.to(h)];
  }
  return degree;
}

}  // namespace

std::vector<std::vector<Index>> find_corner_facets(const TriMesh& mesh,
                                                   const std::vector<float>& bend, double shallow,
                                                   double angle) {
  const std::vector<Index> degree = bent_degrees(mesh, bend, angle);
  DisjointSets facets(mesh.face_count());
  std::vector<std::uint8_t> is_corner(mesh.faces.size(), 1);
  const auto is_inside = [&](Index h) { return mesh.twin[h] != kNone && bend[h] <= kFlatBend; };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_inside(h)) facets.unite(TriMesh::face_of(h), TriMesh::face_of(mesh.twin[h]));
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_inside(h)) continue;
    const bool may_be_around = bend[h] > shallow && bend[h] <= angle &&
                               std::min(degree[mesh.from(h)], degree[mesh.to(h)]) >= kFewestCreases;
    if (!may_be_around) is_corner[facets.find(TriMesh::face_of(h))] = 0;
  }
  std::vector<std::vector<Index>> around(mesh.faces.size());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index facet = facets.find(TriMesh::face_of(h));
    if (is_corner[facet] != 0 && !is_inside(h)) around[facet].push_back(h);
  }
  std::erase_if(around, [](const std::vector<Index>& edges) { return edges.empty(); });
  return around;
}

}  // namespace strake::import
