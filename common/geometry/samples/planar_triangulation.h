#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// A constrained Delaunay triangulation of points in the plane, built by insertion (Bowyer 1981,
/// Watson 1981).
///
/// Points are rounded to a grid of 2^25 cells across the domain and all decisions are made in exact
/// integer arithmetic, so it cannot end up inconsistent. Four corners of a far frame are vertices
/// 0 to 3; the first inserted point is vertex kFirstVertex.
class PlanarTriangulation {
 public:
  static constexpr Index kFirstVertex = 4;

  struct Triangle {
    std::array<Index, 3> vertices;       ///< counter-clockwise
    std::array<Index, 3> neighbours;     ///< across the edge opposite each vertex
    std::array<std::uint8_t, 3> locked;  ///< whether that edge is kept for good
    bool inside = false;                 ///< see `mark_inside`
    std::uint32_t version = 0;           ///< changes when the triangle does
  };

  /// An edge on the rim of the hole that a new point makes.
  struct CavityEdge {
    Index from, to, outer;  ///< outer: the triangle beyond
    std::uint8_t locked;
  };

  /// \pre lower < upper: the domain; all points lie in it
  PlanarTriangulation(const Vec2& lower, const Vec2& upper);

  /// Adds a point. \return its vertex, or kNone where it is one already or lies on a locked edge
  Index insert(const Vec2& point);

  /// Finds the triangles that a point would replace; false where it cannot be inserted. `near` is a
  /// triangle to start from. With `within`, locked edges may not be crossed on the way.
  bool open_cavity(const Vec2& point, Index near, bool within);
  [[nodiscard]] const std::vector<CavityEdge>& cavity() const { return cavity_edges_; }
  /// Inserts the point of the last successful `open_cavity`. \return its vertex
  Index fill_cavity();
  /// Triangles made by the last insertion.
  [[nodiscard]] const std::vector<Index>& fresh() const { return fresh_; }

  /// Keeps an edge for good. \return false where there is no such edge
  bool lock_edge(Index a, Index b);

  /// Marks the triangles that are separated from the frame by an odd number of locked edges.
  void mark_inside();

  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  [[nodiscard]] Vec2 circumcentre(Index triangle) const;

 private:
  struct GridPoint {
    std::int64_t x, y;
  };

  [[nodiscard]] GridPoint to_grid(const Vec2& p) const;
  [[nodiscard]] int orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c) const;
  [[nodiscard]] bool in_circle(const Triangle& t, const GridPoint& p) const;
  [[nodiscard]] Index locate(const GridPoint& p, Index start, bool within) const;
  Index new_triangle(std::size_t reuse);

  Vec2 centre_;
  double scale_;
  std::vector<GridPoint> points_;
  std::vector<Index> triangle_of_;  ///< [points] one triangle around each
  std::vector<Triangle> triangles_;

  GridPoint pending_{};
  std::vector<Index> cavity_;
  std::vector<CavityEdge> cavity_edges_;
  std::vector<Index> fresh_;
  std::vector<std::uint32_t> visited_;  ///< [triangles] number of the last search that saw it
  std::vector<Index> leaving_;  ///< [points] scratch: the new triangle whose edge starts here
  std::uint32_t search_ = 0;
};

}  // namespace strake
