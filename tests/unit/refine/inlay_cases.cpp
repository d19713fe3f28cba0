#include "tests/unit/refine/inlay_cases.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <vector>

namespace strake {

using support::Case;

Vec3 area_vector(const std::vector<Vec3>& positions, const std::array<Index, 3>& t) {
  return (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]) / 2;
}

double area(const std::vector<Vec3>& positions,
            const std::vector<std::array<Index, 3>>& triangles) {
  double sum = 0;
  for (const auto& t : triangles) sum += area_vector(positions, t).norm();
  return sum;
}

std::vector<Vec3> positions_of(const Inlay& inlay, const ComparedSurfaces& surfaces) {
  std::vector<Vec3> positions;
  for (const Index v : inlay.outline) positions.push_back(surfaces.positions()[v]);
  for (const SurfacePoint& p : inlay.points) positions.push_back(place_of(surfaces.mesh(), p));
  return positions;
}

std::set<Index> nine_cells(const InlayCutter& cutter) {
  std::set<Index> cells = {3 * 8 + 4};
  cutter.add_ring(cells);
  return cells;
}

Case flat_sheets(std::size_t count, Index cells, const support::Height& last) {
  std::vector<support::Height> heights;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    heights.emplace_back([i](double, double) { return 2.0 * static_cast<double>(i); });
  }
  heights.push_back(last);
  return support::sheets(8, cells, heights);
}

Case with_holes(const Case& whole, Index n, const std::set<Index>& cells,
                const std::set<Index>& surface) {
  const auto index = [&](double x) { return std::min<Index>(n - 1, static_cast<Index>(n * x)); };
  const auto cell_at = [&](const Vec3& p) { return n * index(p.y()) + index(p.x()); };
  PolyMesh soup;
  std::map<Index, Index> number;
  for (const auto& t : whole.mesh.faces) {
    Vec3 middle = whole.mesh.origin;
    for (const Index v : t) middle += whole.mesh.positions[v] / 3;
    if (surface.contains(cell_at(middle))) continue;
    std::array<Index, 3> face = t;
    for (Index& v : face) {
      const auto [at, is_new] = number.try_emplace(v, soup.vertex_count());
      if (is_new) soup.positions.push_back(whole.mesh.positions[v] + whole.mesh.origin);
      v = at->second;
    }
    soup.add_face(face);
  }
  Case result;
  result.mesh = support::plain_tri_mesh(soup);
  result.quads.mesh.positions = whole.quads.mesh.positions;
  for (Index f = 0; f < whole.quads.mesh.face_count(); ++f) {
    if (!cells.contains(f)) result.quads.mesh.add_face(whole.quads.mesh.face(f));
  }
  for (const Vec3& p : whole.quads.mesh.positions) {
    const auto at = std::ranges::find(soup.positions, p);
    const auto v = static_cast<std::size_t>(at - soup.positions.begin());
    const Index h = at == soup.positions.end() ? 0 : result.mesh.vertex_out[v];
    std::array<double, 3> barycentric = {0, 0, 0};
    barycentric[h % 3] = 1;
    result.quads.provenance.face.push_back(TriMesh::face_of(h));
    result.quads.provenance.barycentric.push_back(barycentric);
    result.quads.provenance.lines.push_back({kNone, kNone});
  }
  return result;
}

}  // namespace strake
