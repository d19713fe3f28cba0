#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/surface_lines.h"
#include "common/geometry/surface_point.h"

namespace strake {

/// Finds where new vertices of a result belong on the surface.
class SurfacePoints {
 public:
  /// \param mesh  kept by reference
  explicit SurfacePoints(const TriMesh& mesh);

  /// The middle between two surface points: on the feature or boundary line that joins them, if one
  /// does; else on the cut of a plane along `normal`; else the surface point nearest to `middle`.
  /// \param middle  relative to the mesh's origin
  /// \param normal  of the result there, any length
  [[nodiscard]] SurfacePoint between(const SurfacePoint& a, const SurfacePoint& b,
                                     const Vec3& middle, const Vec3& normal) const;
  /// Whether a point lies on a feature or boundary line.
  [[nodiscard]] bool is_on_line(const SurfacePoint& point) const {
    return !lines_.places(point).empty();
  }
  /// Whether the straight way between two points runs along a feature or boundary line.
  [[nodiscard]] bool has_line_along(const SurfacePoint& a, const SurfacePoint& b) const {
    return lines_.has_along(a, b);
  }

 private:
  /// The surface point nearest to a place, of those that face the same way, if there are any: not
  /// of the other side of a thin wall.
  [[nodiscard]] SurfacePoint nearest(const Vec3& p, const Vec3& normal) const;

  const TriMesh& mesh_;
  SurfaceLines lines_;
  SurfaceDistance surface_;
  FaceNormals normals_;
};

}  // namespace strake
