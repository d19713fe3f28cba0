#include "stages/smooth/guide_pull.h"

#include <complex>
#include <queue>

#include "common/geometry/frames.h"

namespace strake {
namespace {

/// Directions at the corners of the faces that guides pass: where there are several, the cross
/// that fits them best.
std::vector<Vec3> passed_directions(const TriMesh& mesh, const PrincipalField& field) {
  const LaidGuides& guides = field.guides;
  const auto wedges = static_cast<std::size_t>(mesh.wedge_count());
  std::vector<std::complex<double>> power(wedges);
  std::vector<Vec3> direction(wedges, Vec3::Zero());
  for (Index piece = 0; piece < guides.piece_count(); ++piece) {
    const Index face = guides.face[piece];
    const Vec3 normal = face_cross(mesh, face).normalized();
    for (int i = 0; i < 3; ++i) {
      const Index w = mesh.face_wedges[face][i];
      const TangentFrame frame = tangent_frame(field.normal[w]);
      const Vec3 step = rotate_between(normal, field.normal[w], guides.step[piece]);
      const double weight = step.norm() * guides.barycentric[piece][i];
      power[w] += weight * cross_power(frame.tangent_from_world(step));
      if (!(std::abs(power[w]) > 0)) continue;
      const Vec2 arm = cross_arm(power[w], frame.tangent_from_world(step));
      direction[w] = frame.world_from_tangent(arm).normalized();
    }
  }
  return direction;
}

}  // namespace

GuidePull guide_pull(const TriMesh& mesh, const WedgeGraph& graph, const PrincipalField& field,
                     double reach) {
  GuidePull pull{passed_directions(mesh, field), std::vector<double>(mesh.wedge_vertex.size(), 1)};
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    if (pull.direction[w].isZero()) continue;
    pull.distance[w] = 0;
    queue.emplace(0, w);
  }
  while (!queue.empty()) {
    const auto [reached, w] = queue.top();
    queue.pop();
    if (reached > pull.distance[w]) continue;
    for (Index at = graph.offsets[w]; at < graph.offsets[w + 1]; ++at) {
      const Index other = graph.neighbours[at];
      const double length =
          (mesh.positions[mesh.wedge_vertex[other]] - mesh.positions[mesh.wedge_vertex[w]]).norm();
      const double next = reached + length / reach;
      if (!(next < pull.distance[other])) continue;
      pull.distance[other] = next;
      pull.direction[other] =
          rotate_between(field.normal[w], field.normal[other], pull.direction[w]);
      queue.emplace(next, other);
    }
  }
  return pull;
}

}  // namespace strake
