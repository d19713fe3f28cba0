#pragma once

#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/refine/section_path.h"

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
    return !on_lines(point).empty();
  }

 private:
  /// The surface point nearest to a place, of those that face the same way, if there are any: not
  /// of the other side of a thin wall.
  [[nodiscard]] SurfacePoint nearest(const Vec3& p, const Vec3& normal) const;
  /// A point of a feature or boundary line.
  struct LinePlace {
    Index halfedge = kNone;  ///< of the line
    double lambda = 0;       ///< along it
  };

  /// Half-edges of lines on which a point lies; at a vertex all that leave it.
  [[nodiscard]] std::vector<LinePlace> on_lines(const SurfacePoint& point) const;
  /// The way along one line, in its sense, from a place to a point of the surface.
  [[nodiscard]] std::vector<LinePlace> way(const LinePlace& from, const SurfacePoint& to,
                                           double longest) const;
  /// The half-edge by which the line of `h` goes on from its end; kNone at corners.
  [[nodiscard]] Index next_on_line(Index h) const;
  [[nodiscard]] Vec3 place(const LinePlace& at) const;

  const TriMesh& mesh_;
  SurfaceDistance surface_;
  FaceNormals normals_;
};

}  // namespace strake
