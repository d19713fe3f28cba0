#include "stages/refine/surface_cells.h"

#include <limits>
#include <queue>
#include <tuple>

#include "stages/refine/section_path.h"

namespace strake {

NearestOnSurface::NearestOnSurface(const TriMesh& mesh, const QuadMesh& quads)
    : mesh_(mesh),
      nearest_(mesh.positions.size(), kNone),
      distance_(nearest_.size(), std::numeric_limits<double>::infinity()),
      in_(mesh.faces.size()) {
  using Entry = std::tuple<double, Index, Index>;  // distance, vertex, vertex of the result
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (Index r = 0; r < quads.mesh.vertex_count(); ++r) {
    const SurfacePoint foot{quads.provenance.face[r], quads.provenance.barycentric[r]};
    feet_.push_back(place_of(mesh, foot));
    in_[foot.face].push_back(r);
    for (const Index v : mesh.faces[foot.face]) {
      queue.emplace((mesh.positions[v] - feet_.back()).norm(), v, r);
    }
  }
  while (!queue.empty()) {
    const auto [reached, v, r] = queue.top();
    queue.pop();
    if (nearest_[v] != kNone) continue;
    nearest_[v] = r;
    distance_[v] = reached;
    const Index first = mesh.vertex_out[v];
    for (Index h = first; h != kNone;) {
      for (const Index w : {mesh.to(h), mesh.from(TriMesh::prev(h))}) {
        const double there = reached + (mesh.positions[w] - mesh.positions[v]).norm();
        if (nearest_[w] == kNone) queue.emplace(there, w, r);
      }
      h = mesh.rotate_ccw(h);
      if (h == first) break;
    }
  }
}

Index NearestOnSurface::vertex(Index face, const Vec3& place) const {
  Index best = kNone;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](Index r, double distance) {
    if (!(distance < least)) return;
    least = distance;
    best = r;
  };
  for (const Index v : mesh_.faces[face]) {
    if (nearest_[v] != kNone) look(nearest_[v], distance_[v] + (mesh_.positions[v] - place).norm());
  }
  const auto look_in = [&](Index f) {
    for (const Index r : in_[f]) look(r, (feet_[r] - place).norm());
  };
  look_in(face);
  for (int i = 0; i < 3; ++i) {
    const Index twin = mesh_.twin[3 * face + i];
    if (twin != kNone) look_in(TriMesh::face_of(twin));
  }
  return best;
}

}  // namespace strake
