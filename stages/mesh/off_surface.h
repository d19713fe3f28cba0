#pragma once

#include "stages/mesh/edge_heights.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Prices edges inside an outline by how far they lie off the surface.
///
/// Shapes alone do not tell: in the wall of a hole an edge between two places of one rim makes a
/// well-shaped face, and closes the hole halfway.
class OffSurface {
 public:
  /// \param heights  kept by reference; nullptr: edges are free
  OffSurface(const PolygonGraph& graph, const DartLoop& outline, const EdgeHeights* heights);

  /// Price of a straight edge, beside shape penalties (see shape_penalty). 0 where the surface
  /// along the outline is nearly flat.
  [[nodiscard]] double price(const Vec3& a, const Vec3& b) const;

 private:
  const EdgeHeights* heights_;  ///< nullptr where edges are free
};

}  // namespace strake
