#pragma once

#include <array>

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

/// Relative to the mesh's origin.
inline Vec3 place_of(const TriMesh& mesh, const SurfacePoint& point) {
  Vec3 place = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    place += point.barycentric[i] * mesh.positions[mesh.faces[point.face][i]];
  }
  return place;
}

}  // namespace strake
