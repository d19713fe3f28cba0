#include "common/geometry/nearest_on_surface.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <unordered_set>

#include "common/geometry/surface_point.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {

NearestOnSurface::NearestOnSurface(const TriMesh& mesh, const QuadMesh& quads) : mesh_(mesh) {
  for (Index r = 0; r < quads.mesh.vertex_count(); ++r) {
    const SurfacePoint foot = foot_of(quads.provenance, r);
    feet_.push_back(place_of(mesh, foot));
    by_face_.emplace_back(foot.face, r);
  }
  std::ranges::sort(by_face_);
}

Index NearestOnSurface::vertex(Index face, const Vec3& place) const {
  Index best = kNone;
  double least = std::numeric_limits<double>::infinity();
  // All vertices of the result in a face, from a place whose distance is known.
  const auto look_in = [&](Index f, const Vec3& from, double reached) {
    for (auto at = std::ranges::lower_bound(by_face_, std::pair{f, Index{0}});
         at != by_face_.end() && at->first == f; ++at) {
      const double distance = reached + (feet_[at->second] - from).norm();
      if (distance > least || (distance == least && at->second > best)) continue;
      least = distance;
      best = at->second;
    }
  };
  look_in(face, place, 0);
  for (Index h = 3 * face; h < 3 * face + 3; ++h) {
    const Index twin = mesh_.twin[h];
    if (twin != kNone) look_in(TriMesh::face_of(twin), place, 0);
  }
  using Entry = std::pair<double, Index>;  // distance, vertex of the mesh
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::unordered_set<Index> settled;
  for (const Index v : mesh_.faces[face]) queue.emplace((mesh_.positions[v] - place).norm(), v);
  while (!queue.empty()) {
    const double reached = queue.top().first;  // no bindings: clang 14 takes none into lambdas
    const Index v = queue.top().second;
    queue.pop();
    if (reached > least) break;
    if (!settled.insert(v).second) continue;
    const Vec3& here = mesh_.positions[v];
    for_each_outgoing(mesh_, v, [&](Index h) {
      look_in(TriMesh::face_of(h), here, reached);
      for (const Index w : {mesh_.to(h), mesh_.from(TriMesh::prev(h))}) {
        const double there = reached + (mesh_.positions[w] - here).norm();
        if (there <= least && !settled.contains(w)) queue.emplace(there, w);
      }
    });
  }
  return best;
}

}  // namespace strake
