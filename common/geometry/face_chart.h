#pragma once

#include <array>
#include <optional>

#include "common/core/tri_mesh.h"

namespace strake {

/// A face laid isometrically into the plane: the local parameterisation of [MK04] section 3.1.
struct FaceChart {
  Index face = kNone;
  std::array<Vec2, 3> corner;  ///< counter-clockwise

  /// Barycentric coordinates of a point; the centroid's where the face has no area.
  [[nodiscard]] Vec3 barycentric(const Vec2& point) const;
  [[nodiscard]] Vec2 point(const Vec3& barycentric) const {
    return corner[0] * barycentric[0] + corner[1] * barycentric[1] + corner[2] * barycentric[2];
  }
};

/// The frame that ties a chart to space: chart x and y axes as world vectors.
struct ChartAxes {
  Vec3 x;
  Vec3 y;
};

/// Lays out a face on its own: corner 0 at the origin, corner 1 on the positive x axis.
FaceChart lay_out(const TriMesh& mesh, Index face);

/// World directions of the axes of `lay_out(mesh, face)`; `normal` is used where the face is thin.
ChartAxes chart_axes(const TriMesh& mesh, Index face, const Vec3& normal);

/// Unfolds the face across half-edge `h` of the chart's face into the same plane.
/// \pre h has a twin
FaceChart unfold(const TriMesh& mesh, const FaceChart& chart, Index h);

/// Where a straight line leaves a face.
struct FaceExit {
  Index halfedge = kNone;  ///< of the face left
  double lambda = 0;       ///< along `halfedge`, in [0, 1]
  double step = 0;         ///< share of the displacement used, in [0, 1)
};

/// Follows `displacement` from `point` inside the chart's face; nullopt where it ends inside.
/// \param closed half-edges of this face that are no way out: the one through which the line came
///               in, or the two at the vertex it starts from; kNone for none
std::optional<FaceExit> find_exit(const FaceChart& chart, const Vec2& point,
                                  const Vec2& displacement, const std::array<Index, 2>& closed);

/// A way to leave a vertex: into `face`, whose corner at the vertex is half-edge `corner`, at
/// `angle` counter-clockwise from that half-edge (radians, within the corner).
struct VertexExit {
  Index corner = kNone;
  double angle = 0;
};

/// Goes straight through a vertex in the polar map of its one-ring, which scales the corner angles
/// to a full turn ([MK04] section 3.1, case 3, after Welch and Witkin 1994).
/// \param corner  half-edge of the face the line comes from, starting at the vertex
/// \param angle   of the direction *back* along the line, counter-clockwise from `corner`
/// \return the way out; nullopt where the vertex is on the boundary and the way out leaves the
/// surface
std::optional<VertexExit> cross_vertex(const TriMesh& mesh, Index corner, double angle);

}  // namespace strake
