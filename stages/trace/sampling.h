#pragma once

#include <array>
#include <complex>
#include <vector>

#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/geometry/border_course.h"
#include "common/geometry/face_chart.h"
#include "common/geometry/mesh_measures.h"
#include "stages/trace/spacing.h"

/// What lines look at: the surface and its directions, face by face.
namespace strake {

/// Everything a line needs to know about the surface; shared, immutable.
struct TraceDomain {
  const TriMesh& mesh;
  const PrincipalField& field;
  const Spacing& spacing;
  FaceNormals face_normals;
  BorderCourse borders = {};  ///< empty: boundaries are as they are

  /// Chart direction -> world, for a chart in the position of `lay_out`.
  [[nodiscard]] ChartAxes axes(Index face) const {
    return chart_axes(mesh, face, face_normals[face]);
  }
};

/// The direction field over one face in the plane of its chart: the parameterisation *context* of
/// [MK04] section 3.1. A plain value: saving and restoring it is copying.
struct FieldContext {
  FaceChart chart;
  std::array<Vec2, 3> arm;                    ///< cross arm at each corner, unit
  std::array<std::complex<double>, 3> power;  ///< symmetric representation that is interpolated
  bool reliable = true;  ///< whether the corners agree enough to follow the field here
};

/// The context of a face in the position of `lay_out`.
FieldContext field_context(const TraceDomain& domain, Index face);

/// The context across half-edge `h`, unfolded into the plane of `context`.
FieldContext unfold_context(const TraceDomain& domain, const FieldContext& context, Index h);

/// Field direction at a point of the face, as close as possible to `heading`.
///
/// With an extended cross field the four arms are equal; else the line keeps to its family
/// ([MK04]) and only the sign is free. `heading` itself where the field is unreliable.
Vec2 field_direction(const TraceDomain& domain, const FieldContext& context, const Vec2& point,
                     const Vec2& heading, LineFamily family);

/// Which family a line of direction `heading` belongs to at a point ([MK04] section 4.2).
LineFamily family_at(const TraceDomain& domain, const FieldContext& context, const Vec2& point,
                     const Vec2& heading);

/// Wanted distances at a point for a line of direction `heading`.
struct LocalSpacing {
  double to_neighbours = 0;  ///< across the line: to the next lines beside it
  double along = 0;          ///< along the line: between the lines that cross it
};
LocalSpacing spacing_at(const TraceDomain& domain, const FieldContext& context, const Vec2& point,
                        const Vec2& heading);

/// World position of a chart point.
Vec3 world_point(const TraceDomain& domain, const FieldContext& context, const Vec2& point);

/// World direction of a chart direction, and back (projected into the face; not normalised).
Vec3 world_direction(const TraceDomain& domain, const FieldContext& context, const Vec2& direction);
Vec2 chart_direction(const TraceDomain& domain, const FieldContext& context, const Vec3& direction);

}  // namespace strake
