#pragma once

#include <vector>

#include "stages/mesh/cell_shape.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Tells which diagonals run inside a cell, and where it is concave.
///
/// A cell is seen along its normal. The outline of one that winds around a pipe, or along a spiral,
/// crosses itself from wherever one looks: there each corner is seen along the normal of the
/// surface.
class CellView {
 public:
  /// \param p  the corners of the cell, as of `corner_positions`
  CellView(const PolygonGraph& graph, const DartLoop& cell, const Polygon& p);

  /// Whether the surface turns by more than 90 degrees from the cell's normal at a corner inside of
  /// lines, and the outline crosses itself as seen along that normal.
  [[nodiscard]] bool is_folded() const { return !normals_.empty(); }
  /// Unit normal of the surface at a corner of a folded cell; else that of the cell.
  [[nodiscard]] const Vec3& normal(std::size_t i) const {
    return is_folded() ? normals_[i] : normal_;
  }
  /// Unit normal along which the face of the corners i, ..., j is seen; j may be below i.
  [[nodiscard]] Vec3 normal_of(std::size_t i, std::size_t j) const;
  /// Whether the diagonal leaves both corners into the cell and crosses no edge.
  [[nodiscard]] bool contains(std::size_t i, std::size_t j) const;

 private:
  void look_along_surface(const PolygonGraph& graph, const DartLoop& cell);
  [[nodiscard]] bool leaves_inwards(std::size_t i, std::size_t j) const;
  [[nodiscard]] bool is_crossed(std::size_t i, std::size_t j) const;
  [[nodiscard]] bool is_crossed_nearby(std::size_t i, std::size_t j) const;

  Polygon corners_;
  Vec3 normal_;
  std::vector<Vec2> flat_;     ///< [corners] seen along normal_
  std::vector<Vec3> normals_;  ///< [corners] of a folded cell
};

}  // namespace strake
