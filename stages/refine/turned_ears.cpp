#include "stages/refine/turned_ears.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/flat_triangle.h"
#include "common/geometry/patch_fill/drop_unused_vertices.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"

namespace strake {
namespace {

/// Whether a face is turned against the surface under its corners, or has no area.
bool is_turned_over(const SurfacePoints& points, const QuadMesh& quads, Index f) {
  const std::span<const Index> face = quads.mesh.face(f);
  Vec3 normal = Vec3::Zero();
  double longest = 0;
  for (std::size_t i = 0; i < face.size(); ++i) {
    normal += points.normal(foot_of(quads.provenance, face[i]));
    const Vec3 side =
        quads.mesh.positions[face[(i + 1) % face.size()]] - quads.mesh.positions[face[i]];
    longest = std::max(longest, side.norm());
  }
  const Vec3 own = newell_normal(quads.mesh.positions, face);
  return own.dot(normal) < 0 || own.norm() <= kFlatHeight * longest * longest;
}

/// Those that are beside no other one. \return whether there were any
bool drop_some(const SurfacePoints& points, QuadMesh& quads) {
  const PolyMesh& mesh = quads.mesh;
  const PolyEdges edges = collect_edges(mesh);
  std::vector<Index> inner_sides(static_cast<std::size_t>(mesh.face_count()), 0);
  std::vector<Index> beyond(inner_sides.size(), kNone);
  const std::vector<Index> opposite = opposite_sides(edges);
  for (std::size_t c = 0; c < opposite.size(); ++c) {
    if (opposite[c] == kNone) continue;
    const Index f = edges.corner_face[c];
    ++inner_sides[f];
    beyond[f] = edges.corner_face[opposite[c]];
  }
  PolyMesh kept;
  std::vector<char> stays(inner_sides.size(), 0);  // 1: beside one that goes
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (inner_sides[f] == 1 && stays[f] == 0 && is_turned_over(points, quads, f)) {
      stays[beyond[f]] = 1;
    } else {
      kept.add_face(mesh.face(f));
    }
  }
  if (kept.face_count() == mesh.face_count()) return false;
  quads.mesh.corners = std::move(kept.corners);
  quads.mesh.offsets = std::move(kept.offsets);
  drop_unused_vertices(quads);
  return true;
}

}  // namespace

void drop_turned_ears(const SurfacePoints& points, QuadMesh& quads) {
  while (drop_some(points, quads)) {
  }
}

}  // namespace strake
