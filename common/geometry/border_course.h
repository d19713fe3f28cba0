#pragma once

#include <cstdint>
#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/surface_point.h"

namespace strake {

/// Share of a tolerance that the course may be off the boundary; the rest is for cells.
inline constexpr double kCourseOfTolerance = 0.5;

/// The course that the boundary of a surface has at the scale of cells.
///
/// A surface cut along its triangles has a saw for a boundary: it turns to and fro at nearly every
/// vertex, though it goes on straight for whoever looks from a few edges away. The course of such a
/// piece is the mean of the boundary over half a cell to both sides, or a tooth where that is more,
/// weighted less the farther away. Elsewhere it is the boundary itself: where the boundary does not
/// turn to and fro at single vertices (arcs, polygons, teeth with a top), where teeth are as wide
/// as cells, where features meet it, and where the mean would be farther off than it may be.
struct BorderCourse {
  /// [V] from a vertex to the course, model units; zero off ragged boundaries. Along an edge in
  /// between it changes linearly. Empty: no boundary is ragged.
  std::vector<Vec3> offset;
  /// [V] unit direction of the boundary from a vertex on, as `ragged_directions`.
  std::vector<Vec3> direction;
  /// [V] those of the mesh, without vertices at which the course does not turn.
  std::vector<std::uint8_t> is_corner;

  /// That of a point of the surface: of the boundary, or zero.
  [[nodiscard]] Vec3 offset_at(const TriMesh& mesh, const SurfacePoint& point) const;
  /// Whether an end of a half-edge of the boundary is off its course.
  [[nodiscard]] bool is_off(const TriMesh& mesh, Index h) const {
    return !offset.empty() && !(offset[mesh.from(h)].isZero(0) && offset[mesh.to(h)].isZero(0));
  }
  /// The place of a vertex on the course.
  [[nodiscard]] Vec3 place(const TriMesh& mesh, Index v) const {
    return offset.empty() ? mesh.positions[v] : Vec3(mesh.positions[v] + offset[v]);
  }
};

/// \param size  [V] wanted length of edges along the boundary at its vertices, model units; 0
///              leaves the boundary as it is
/// \param most_off  most distance of the boundary from its course, model units
/// Cost O(V) and, for ragged boundaries, boundary vertices times those within a cell.
BorderCourse border_course(const TriMesh& mesh, const std::vector<double>& size, double most_off);

/// [V] the smaller of two distances between lines, [W], at boundary vertices; 0 elsewhere.
std::vector<double> sizes_at_vertices(const TriMesh& mesh, const std::vector<double>& along,
                                      const std::vector<double>& across);

/// [V] unit direction of the boundary on from a vertex, with the surface on its left, as it is from
/// a few edges away; zero off ragged pieces. Empty: there are none.
std::vector<Vec3> ragged_directions(const TriMesh& mesh);

}  // namespace strake
