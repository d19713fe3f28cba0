#include "tests/unit/mesh/grid_cells.h"

#include <array>
#include <cmath>

#include "common/core/poly_mesh.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"

namespace strake {

std::vector<double> steps(int n) {
  std::vector<double> places;
  for (int i = 0; i < n; ++i) places.push_back(i);
  return places;
}

TriMesh grid_mesh(const Grid& grid) {
  PolyMesh soup;
  const auto columns = static_cast<Index>(grid.x.size());
  const auto rows = static_cast<Index>(grid.y.size());
  for (Index j = 0; j < rows; ++j) {
    for (Index i = 0; i < columns; ++i) soup.positions.emplace_back(grid.x[i], grid.y[j], 0);
  }
  for (Index j = 0; j + 1 < rows; ++j) {
    for (Index i = 0; i + 1 < columns; ++i) {
      const Index a = j * columns + i;
      soup.add_face(std::array<Index, 3>{a, a + 1, a + columns + 1});
      soup.add_face(std::array<Index, 3>{a, a + columns + 1, a + columns});
    }
  }
  TriMesh mesh = support::plain_tri_mesh(soup);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 p = mesh.positions[v] + mesh.origin;
    const bool side = p.x() == grid.x.front() || p.x() == grid.x.back();
    if (side && (p.y() == grid.y.front() || p.y() == grid.y.back())) mesh.is_corner[v] = 1;
  }
  return mesh;
}

PolygonGraph cells_of(const TriMesh& mesh, const KeepEdge& keep, const KeepEdge& is_feature) {
  Overlay overlay = overlay_of(mesh);
  for (Index e = 0; e < overlay.graph.dart_count() / 2; ++e) {
    if (overlay.kind[e] != EdgeKind::surface) continue;
    const Vec3 a = overlay.nodes[overlay.graph.from(2 * e)].position + mesh.origin;
    const Vec3 b = overlay.nodes[overlay.graph.to(2 * e)].position + mesh.origin;
    if (keep(a, b)) overlay.kind[e] = EdgeKind::line;
    if (is_feature(a, b)) overlay.kind[e] = EdgeKind::feature;
  }
  reduce_to_lines(overlay);
  return {mesh, overlay};
}

std::map<std::size_t, int> sides(const PolygonGraph& graph) {
  std::map<std::size_t, int> count;
  std::set<Index> seen;
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d) || graph.is_hole(d)) continue;
    if (seen.insert(graph.name_of_cell(d)).second) ++count[graph.cell(d).size()];
  }
  return count;
}

std::set<std::pair<double, double>> places(const PolygonGraph& graph, const TriMesh& mesh) {
  std::set<std::pair<double, double>> found;
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d)) continue;
    const Vec3 p = graph.position(graph.graph().from(d)) + mesh.origin;
    found.emplace(std::round(p.x() * 1e9) / 1e9, std::round(p.y() * 1e9) / 1e9);
  }
  return found;
}

}  // namespace strake
