#pragma once

#include <optional>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/surface_lines.h"
#include "common/geometry/surface_point.h"
#include "common/geometry/topology/own_component.h"
#include "stages/refine/boundary_ways.h"

namespace strake {

/// Finds where new vertices of a result belong on the surface.
class SurfacePoints {
 public:
  /// \param mesh  kept by reference
  explicit SurfacePoints(const TriMesh& mesh);

  /// The middle between two surface points inside the surface: on the feature line that joins them,
  /// if one does; else on the cut of a plane along `normal`; else the surface point nearest to
  /// `middle`. Not on the boundary line between two points of it, as vertices of edges of the
  /// boundary lie there.
  /// \param middle  relative to the mesh's origin
  /// \param normal  of the result there, any length
  [[nodiscard]] SurfacePoint between(const SurfacePoint& a, const SurfacePoint& b,
                                     const Vec3& middle, const Vec3& normal) const;
  /// The middle between two points of the boundary, on it.
  /// \param from, to  in the sense in which the surface lies on the left
  /// \return nothing where `BoundaryWays` knows no way
  [[nodiscard]] std::optional<SurfacePoint> between_on_boundary(const SurfacePoint& from,
                                                                const SurfacePoint& to) const;
  /// Where the boundary between two points of it turns sharply to and fro, as it is jagged: its
  /// corners up to a distance from straight pieces; else empty.
  /// \param normal  of the surface there, any length
  [[nodiscard]] std::vector<SurfacePoint> jags_between(const SurfacePoint& from,
                                                       const SurfacePoint& to, const Vec3& normal,
                                                       double within) const;
  /// How far the boundary goes away from the straight way between two points of it; 0 where
  /// `BoundaryWays` knows no way.
  [[nodiscard]] double boundary_height(const SurfacePoint& from, const SurfacePoint& to) const;
  /// The unit normal of the face that a point is of.
  [[nodiscard]] Vec3 normal(const SurfacePoint& point) const { return normals_[point.face]; }
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
  /// \param reach  farther away none is looked for that faces the same way
  /// \param own    a face of the component that it is on
  [[nodiscard]] SurfacePoint nearest(const Vec3& p, const Vec3& normal, double reach,
                                     Index own) const;

  /// Where a way along a line is best divided.
  [[nodiscard]] SurfacePoint split_of(const std::vector<SurfaceLines::Place>& line) const;
  [[nodiscard]] std::vector<Vec3> positions(const std::vector<SurfaceLines::Place>& line) const;

  const TriMesh& mesh_;
  SurfaceLines lines_;
  BoundaryWays boundary_;
  SurfaceDistance surface_;
  FaceNormals normals_;
  OwnComponent components_;
};

}  // namespace strake
