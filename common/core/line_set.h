#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/core/types.h"

namespace strake {

enum class LineFamily : std::uint8_t { minimum, maximum, boundary, feature };

/// Why a line ends where it does.
enum class LineEnd : std::uint8_t {
  closed,      ///< joined its own start
  proximity,   ///< came too close to a line of its direction
  boundary,    ///< reached the boundary of the surface
  feature,     ///< met a feature line at too flat an angle, or ended on it
  step_limit,  ///< the hard bound on steps
  stuck,       ///< no way on: a degenerate spot of the mesh or field
  node,        ///< feature and boundary lines: a corner
};

/// A point of a line, on an edge or at a vertex of the mesh.
struct LinePoint {
  Index halfedge =
      kNone;          ///< edge points: either half-edge of the edge; vertices: any outgoing one
  double lambda = 0;  ///< in [0, 1) along `halfedge`; exactly 0 means its origin vertex
};

/// Lines on a TriMesh as sequences of crossings, one straight chord per face in between
/// ([MK04] section 3.2: "all of its segments are contained in just one face").
struct LineSet {
  std::string mesh_id;

  std::vector<Index> offsets = {
      0};  ///< [L + 1] line l has the points offsets[l] .. offsets[l + 1] - 1
  std::vector<LinePoint> points;  ///< [P]; a closed line does not repeat its first point
  /// [P] face of the chord from this point to the next of its line (to the first, after the last
  /// point of a closed line); kNone after the last point, and where the chord runs along an edge
  /// (then `points[i].halfedge` is that edge's half-edge and its lambda is 0).
  std::vector<Index> chord_face;
  std::vector<LineFamily> chord_family;  ///< [P] may change along a line ([MK04] section 4.2)

  std::vector<LineFamily> family;     ///< [L] at the seed
  std::vector<LineEnd> start_reason;  ///< [L]
  std::vector<LineEnd> end_reason;    ///< [L]
  std::vector<Index> seed_point;      ///< [L] index into `points` of the point nearest to the seed

  /// [W] wanted distance between neighbouring lines, model units, graded over the surface: measured
  /// along the field's `cross` (its arm nearest to t_min) and across it.
  std::vector<double> spacing_along_min;
  std::vector<double> spacing_along_max;

  [[nodiscard]] Index line_count() const { return static_cast<Index>(offsets.size()) - 1; }
  [[nodiscard]] bool is_closed(Index line) const { return end_reason[line] == LineEnd::closed; }
};

}  // namespace strake
