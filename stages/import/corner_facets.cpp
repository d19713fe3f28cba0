#include "stages/import/corner_facets.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "stages/import/facets.h"

namespace strake::import {
namespace {

constexpr Index kFewestCreases = 2;  ///< at each corner of a facet

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
  const auto may_be_around = [&](Index h) {
    return bend[h] > shallow && bend[h] <= angle &&
           std::min(degree[mesh.from(h)], degree[mesh.to(h)]) >= kFewestCreases;
  };
  std::vector<std::pair<Index, Index>> around;  // facet, half-edge
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (may_be_around(h)) around.emplace_back(kNone, h);
  }
  if (around.empty()) return {};

  DisjointSets facets(mesh.face_count());
  const auto is_inside = [&](Index h) { return mesh.twin[h] != kNone && bend[h] <= kFlatBend; };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_inside(h)) facets.unite(TriMesh::face_of(h), TriMesh::face_of(mesh.twin[h]));
  }
  std::vector<std::uint8_t> is_corner(mesh.faces.size(), 1);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!is_inside(h) && !may_be_around(h)) is_corner[facets.find(TriMesh::face_of(h))] = 0;
  }
  for (auto& [facet, h] : around) facet = facets.find(TriMesh::face_of(h));
  std::erase_if(around, [&](const auto& side) { return is_corner[side.first] == 0; });
  std::sort(around.begin(), around.end());
  std::vector<std::vector<Index>> result;
  Index last = kNone;
  for (const auto& [facet, h] : around) {
    if (facet != last) result.emplace_back();
    result.back().push_back(h);
    last = facet;
  }
  return result;
}

}  // namespace strake::import
