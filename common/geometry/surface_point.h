#pragma once

#include <array>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// A point is on an edge where a barycentric coordinate is below this, and at a vertex where one is
/// this near to 1.
inline constexpr double kOnEdge = 1e-9;

/// A point of a surface.
struct SurfacePoint {
  Index face = kNone;
  std::array<double, 3> barycentric = {0, 0, 0};
};

/// The corner of its face, as a half-edge, at whose vertex a point is; kNone where it is at none.
inline Index corner_at(const SurfacePoint& point) {
  for (int i = 0; i < 3; ++i) {
    if (point.barycentric[i] >= 1 - kOnEdge) return 3 * point.face + i;
  }
  return kNone;
}

/// Whether a point is on a half-edge of its face, its ends among it.
inline bool is_on_edge(const SurfacePoint& point, Index h) {
  return point.barycentric[TriMesh::prev(h) % 3] < kOnEdge;
}

/// The first half-edge of its face that a point is on and that is wanted; kNone where none is.
template <class IsWanted>
Index edge_at(const SurfacePoint& point, const IsWanted& is_wanted) {
  for (Index h = 3 * point.face; h < 3 * point.face + 3; ++h) {
    if (is_on_edge(point, h) && is_wanted(h)) return h;
  }
  return kNone;
}

/// Which share of the way along a half-edge of its face a point is that is on it.
inline double share_along(const SurfacePoint& point, Index h) {
  return point.barycentric[TriMesh::next(h) % 3];
}

/// The point at a share of the way along a half-edge, in [0, 1], of the face to its left.
inline SurfacePoint point_along(Index h, double share) {
  SurfacePoint point{TriMesh::face_of(h), {0, 0, 0}};
  point.barycentric[h % 3] = 1 - share;
  point.barycentric[TriMesh::next(h) % 3] = share;
  return point;
}

/// A vertex as a point of one of its faces.
inline SurfacePoint point_at_vertex(const TriMesh& mesh, Index vertex) {
  return point_along(mesh.vertex_out[vertex], 0);
}

/// Relative to the mesh's origin.
inline Vec3 place_of(const TriMesh& mesh, const SurfacePoint& point) {
  Vec3 place = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    place += point.barycentric[i] * mesh.positions[mesh.faces[point.face][i]];
  }
  return place;
}

/// Where a vertex of a result comes from.
inline SurfacePoint foot_of(const VertexProvenance& provenance, Index vertex) {
  return {provenance.face[vertex], provenance.barycentric[vertex]};
}

inline void set_foot(VertexProvenance& provenance, Index vertex, const SurfacePoint& foot) {
  provenance.face[vertex] = foot.face;
  provenance.barycentric[vertex] = foot.barycentric;
}

/// Adds one more vertex, at no crossing of lines.
inline void add_foot(VertexProvenance& provenance, const SurfacePoint& foot) {
  provenance.face.push_back(foot.face);
  provenance.barycentric.push_back(foot.barycentric);
  provenance.lines.push_back({kNone, kNone});
}

}  // namespace strake
