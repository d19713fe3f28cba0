#pragma once

#include "common/core/line_set.h"
#include "common/core/tri_mesh.h"

namespace strake {

inline bool is_vertex_point(const LinePoint& p) { return p.lambda == 0; }

/// Whether two points of a line can be joined by a chord through the inside of `face`: they lie on
/// different edges of it, or one is a corner and the other on the opposite edge.
inline bool is_proper_chord(const TriMesh& mesh, Index face, const LinePoint& a,
                            const LinePoint& b) {
  const auto side =
      [&](const LinePoint& p) -> int {  // local edge, or 3 + local corner; -1: not here
    if (is_vertex_point(p)) {
      for (int i = 0; i < 3; ++i) {
        if (mesh.faces[face][i] == mesh.from(p.halfedge)) return 3 + i;
      }
      return -1;
    }
    if (TriMesh::face_of(p.halfedge) == face) return p.halfedge % 3;
    const Index t = mesh.twin[p.halfedge];
    return t != kNone && TriMesh::face_of(t) == face ? t % 3 : -1;
  };
  const int sa = side(a);
  const int sb = side(b);
  if (sa < 0 || sb < 0) return false;
  if (sa < 3 && sb < 3) return sa != sb;
  if (sa >= 3 && sb >= 3) return false;
  const int corner = (sa >= 3 ? sa : sb) - 3;
  const int edge = sa >= 3 ? sb : sa;
  return edge == (corner + 1) % 3;
}

/// Position of a point of a line.
inline Vec3 line_point_position(const TriMesh& mesh, const LinePoint& p) {
  const Vec3& a = mesh.positions[mesh.from(p.halfedge)];
  if (is_vertex_point(p)) return a;
  return a + p.lambda * (mesh.positions[mesh.to(p.halfedge)] - a);
}

}  // namespace strake
