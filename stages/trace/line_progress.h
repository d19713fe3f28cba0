#pragma once

#include "common/core/tri_mesh.h"
#include "stages/trace/half_line.h"
#include "stages/trace/line_head.h"

namespace strake {

/// Tells whether a half line gets anywhere, step by step.
class LineProgress {
 public:
  explicit LineProgress(const LineHead& start) : arc_there_(start.arc), good_arc_(start.arc) {}

  enum class State {
    gets_on,
    stuck,  ///< stands still, or circles within a face
    winds,  ///< goes around something thinner than the distance at which it sees itself
  };

  /// What came of a step.
  /// \param wanted, moved  how long the step was to be, and was
  /// \param own_skip  length along the line within which it does not see itself
  State after_step(const TriMesh& mesh, const LineHead& head, const HalfLine& half, double wanted,
                   double moved, double own_skip);

  /// Points, and places of crossings, of a half line that winds, before it began to.
  [[nodiscard]] std::size_t good_points() const { return good_points_; }
  [[nodiscard]] std::size_t good_places() const { return good_places_; }

 private:
  int standing_ = 0;  ///< steps that led nowhere, in a row
  std::size_t most_points_ = 0;
  double arc_there_ = 0;  ///< of the head when it had recorded so many points
  std::size_t good_points_ = 0;
  std::size_t good_places_ = 0;
  double good_arc_ = 0;
};

}  // namespace strake
