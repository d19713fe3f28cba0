#include "stages/import/facets.h"

#include <cstdint>
#include <vector>

#include "common/geometry/angles.h"
#include "common/geometry/mesh_measures.h"

namespace strake::import {
namespace {

constexpr double kLeast = 10 * kDegree;  ///< bend; rounds of more facets are as good as smooth
constexpr double kLeastShare = 2.0 / 3;

/// Whether each triangle is part of a larger flat polygon. [F]
std::vector<std::uint8_t> in_polygons(const TriMesh& mesh, const std::vector<float>& bend) {
  std::vector<std::uint8_t> result(mesh.faces.size(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == kNone || bend[h] > kFlatBend) continue;
    result[TriMesh::face_of(h)] = 1;
  }
  return result;
}

}  // namespace

std::vector<Index> find_facet_edges(const TriMesh& mesh, const std::vector<float>& bend) {
  const std::vector<std::uint8_t> in_polygon = in_polygons(mesh, bend);
  std::vector<Index> edges;
  double between_facets = 0;
  double length = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin == kNone || h > twin || mesh.is_feature[h] != 0 || bend[h] <= kLeast) continue;
    const double way = edge_length(mesh, h);
    length += way;
    if (in_polygon[TriMesh::face_of(h)] == 0 || in_polygon[TriMesh::face_of(twin)] == 0) continue;
    between_facets += way;
    edges.push_back(h);
  }
  if (between_facets < kLeastShare * length) edges.clear();
  return edges;
}

}  // namespace strake::import
