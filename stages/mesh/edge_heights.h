#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <limits>
#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {

/// How far straight edges between places of a mesh lie off it.
///
/// The edges that nodes near each other could have are asked for again and again, by one patch of
/// cells after the other: each thread remembers the last ones.
class EdgeHeights {
 public:
  /// \param mesh  kept by reference
  explicit EdgeHeights(const TriMesh& mesh) : surface_(mesh.positions, mesh.faces) {}

  /// The largest of the distances from the mesh, model units, of three places on the edge.
  [[nodiscard]] double at(const Vec3& a, const Vec3& b) const;
  /// Normal of the triangle nearest to the middle of the edge, of any length.
  [[nodiscard]] Vec3 normal_below(const Vec3& a, const Vec3& b) const;

 private:
  struct Edge {
    Vec3 a = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< none yet
    Vec3 b = a;
    double height = 0;
  };

  [[nodiscard]] double measure(const Vec3& a, const Vec3& b) const;

  SurfaceDistance surface_;
  mutable tbb::enumerable_thread_specific<std::vector<Edge>> last_;  ///< by a hash of their ends
};

}  // namespace strake
