#include "stages/refine/surface_cells.h"

#include <limits>
#include <queue>
#include <tuple>

#include "stages/refine/section_path.h"

namespace strake {

std::vector<Index> nearest_on_surface(const TriMesh& mesh, const QuadMesh& quads) {
  std::vector<Index> nearest(mesh.positions.size(), kNone);
  std::vector<double> distance(nearest.size(), std::numeric_limits<double>::infinity());
  using Entry = std::tuple<double, Index, Index>;  // distance, vertex, vertex of the result
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (Index r = 0; r < quads.mesh.vertex_count(); ++r) {
    const SurfacePoint foot{quads.provenance.face[r], quads.provenance.barycentric[r]};
    const Vec3 place = place_of(mesh, foot);
    for (const Index v : mesh.faces[foot.face]) {
      queue.emplace((mesh.positions[v] - place).norm(), v, r);
    }
  }
  while (!queue.empty()) {
    const auto [reached, v, r] = queue.top();
    queue.pop();
    if (nearest[v] != kNone) continue;
    nearest[v] = r;
    const Index first = mesh.vertex_out[v];
    for (Index h = first; h != kNone;) {
      for (const Index w : {mesh.to(h), mesh.from(TriMesh::prev(h))}) {
        const double there = reached + (mesh.positions[w] - mesh.positions[v]).norm();
        if (!(there < distance[w])) continue;
        distance[w] = there;
        queue.emplace(there, w, r);
      }
      h = mesh.rotate_ccw(h);
      if (h == first) break;
    }
  }
  return nearest;
}

}  // namespace strake
