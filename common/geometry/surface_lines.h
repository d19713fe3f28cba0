#pragma once

#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/surface_point.h"

namespace strake {

/// The feature and boundary lines of a surface, and ways along them.
class SurfaceLines {
 public:
  /// A point of a line.
  struct Place {
    Index halfedge = kNone;  ///< of the line
    double lambda = 0;       ///< along it
  };

  /// A line joins two points where its way is at most this many times as long as the straight one.
  static constexpr double kLongestLine = 2;

  /// \param mesh  kept by reference
  explicit SurfaceLines(const TriMesh& mesh) : mesh_(mesh) {}

  /// Half-edges of lines on which a point lies; at a vertex all that leave it.
  [[nodiscard]] std::vector<Place> places(const SurfacePoint& point) const;
  /// Whether a point is a corner of the surface, where lines end, meet or turn.
  [[nodiscard]] bool is_corner(const SurfacePoint& point) const;
  /// The shortest way along one line from a point to another, or the other way round; empty where
  /// none is shorter than this, model units.
  [[nodiscard]] std::vector<Place> way_between(const SurfacePoint& a, const SurfacePoint& b,
                                               double longest) const;
  /// Whether the straight way between two points runs along a line that joins them: by a way that
  /// is at most twice as long.
  [[nodiscard]] bool has_along(const SurfacePoint& a, const SurfacePoint& b) const;
  /// Relative to the mesh's origin.
  [[nodiscard]] Vec3 position(const Place& at) const;

 private:
  /// The way along one line, in its sense, from a place to a point of the surface.
  [[nodiscard]] std::vector<Place> way(const Place& from, const SurfacePoint& to,
                                       double longest) const;
  /// The half-edge by which the line of `h` goes on from its end; kNone at corners.
  [[nodiscard]] Index next_on_line(Index h) const;

  const TriMesh& mesh_;
};

}  // namespace strake
