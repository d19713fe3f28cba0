#pragma once

#include "common/core/tri_mesh.h"
#include "common/geometry/mesh_measures.h"

namespace strake {

/// A face seen along its longest edge, by which what lies in it is ordered.
struct FaceRows {
  int base = 0;  ///< corner where the longest edge starts
  double longest = 0;
  Vec3 origin;  ///< the position of that corner
  Vec3 along;   ///< unit, of the edge

  /// How far along the edge a point lies.
  [[nodiscard]] double place(const Vec3& p) const { return along.dot(p - origin); }
};

/// \pre the face has an edge of some length
inline FaceRows face_rows(const TriMesh& mesh, Index face) {
  FaceRows rows;
  for (int i = 0; i < 3; ++i) {
    const Index h = 3 * face + i;
    const double length = edge_length(mesh, h);
    if (length <= rows.longest) continue;
    rows.longest = length;
    rows.base = i;
  }
  const Index h = 3 * face + rows.base;
  rows.origin = mesh.positions[mesh.from(h)];
  rows.along = (mesh.positions[mesh.to(h)] - rows.origin) / rows.longest;
  return rows;
}

}  // namespace strake
