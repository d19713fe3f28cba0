#pragma once

#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/surface_lines.h"
#include "common/geometry/surface_point.h"

namespace strake {

/// Ways along the boundary of a surface, past its corners.
///
/// `SurfaceLines` ends ways at corners. Where a boundary is jagged all its vertices may be corners,
/// and an edge of a result lies over many of them.
class BoundaryWays {
 public:
  /// \param mesh  kept by reference
  explicit BoundaryWays(const TriMesh& mesh);

  /// The way along the boundary from one point to another, with the surface on its left.
  /// \return empty where a point is not on the boundary, they are on different loops, or the way is
  ///         longer than the one back and much longer than the straight one, so that it is hardly
  ///         what an edge between them stands for
  [[nodiscard]] std::vector<SurfaceLines::Place> way(const SurfacePoint& from,
                                                     const SurfacePoint& to) const;

 private:
  /// At a vertex that on the half-edge that leaves it; that of no half-edge elsewhere than on the
  /// boundary.
  [[nodiscard]] SurfaceLines::Place place(const SurfacePoint& point) const;
  /// The length of the boundary from where its loop begins.
  [[nodiscard]] double position_on_loop(const SurfaceLines::Place& place) const;

  const TriMesh& mesh_;
  std::vector<Index> loop_;      ///< [half-edges] kNone: not of the boundary
  std::vector<double> until_;    ///< [half-edges] length of the loop before, model units
  std::vector<double> lengths_;  ///< [loops] model units
};

}  // namespace strake
