#pragma once

#include <optional>
#include <vector>

#include "stages/trace/coverage.h"
#include "stages/trace/finished_lines.h"
#include "stages/trace/half_line.h"
#include "stages/trace/proximity.h"
#include "stages/trace/sampling.h"

namespace strake {

/// A finished line, in the representation of LineSet.
struct TracedLine {
  std::vector<LinePoint> points;
  std::vector<Index> chord_face;         ///< [P] face of the chord to the next point
  std::vector<LineFamily> chord_family;  ///< [P]
  LineFamily family = LineFamily::minimum;
  LineEnd start_reason = LineEnd::stuck;
  LineEnd end_reason = LineEnd::stuck;
  Index seed_point = 0;
};

struct TracerSettings {
  /// Of the wanted distance, below which a line stops: the less, the fewer lines end, and the less
  /// even their distances are.
  double stop_fraction = 0.45;
  double seed_fraction = 0.8;    ///< of the wanted distance, below which a seed is refused
  double gap_fraction = 0.95;    ///< likewise, for seeds that fill gaps
  double cover_fraction = 0.9;   ///< of the wanted distance, within which a point counts as covered
  double narrow_fraction = 0.3;  ///< of the wanted distance, down to which a line may go on where
                                 ///< it gets out of such narrows, or closes, behind them
};

/// What came of a seed.
struct LineDraft {
  bool is_line = false;  ///< else too close to a line of its direction, too short, or an arc
                         ///< between closed lines that is not needed
  TracedLine line;
  std::vector<Seed> spawned;          ///< for lines that cross this one, at their wanted distances
  std::vector<LineSegment> segments;  ///< for the proximity index
  std::vector<CoveredDisc> covered;   ///< also where there is no line, so that nothing is tried
                                      ///< there again
  std::int64_t query_count = 0;
};

/// Traces lines among those that are finished, one at a time ([MK04] sections 3 and 4.2).
class LineTracer {
 public:
  /// \param barriers [3F] half-edges of feature and boundary lines
  /// \param finished  all kept by reference
  LineTracer(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
             const TracerSettings& settings, const FinishedLines& finished);
  LineTracer(const LineTracer&) = delete;  // its parts hold references to each other
  LineTracer& operator=(const LineTracer&) = delete;

  /// Traces the line of a seed in both directions.
  LineDraft trace(const Seed& seed);

  [[nodiscard]] ProximityProbe& proximity() { return proximity_; }

 private:
  /// Both halves of a line, with their segments in the probe.
  struct Halves {
    HalfLine forward;
    HalfLine backward;
    double spacing_along = 0;  ///< wanted at the seed
    LineFamily family = LineFamily::minimum;
  };

  /// Where a half line first came too close to another line, and what it had recorded by then.
  struct Narrows {
    double arc = 0;
    std::size_t points = 0;
    std::size_t places = 0;  ///< of seeds for lines that cross it
    Index stopped_by = kNone;
  };

  bool fits(const LineHead& head, double fraction);
  [[nodiscard]] ProximityQuery query_at(const LineHead& head, double fraction,
                                        const LocalSpacing& spacing) const;
  ProximityHit look_around(const LineHead& head, double fraction, const LocalSpacing& spacing);
  void cover(const LineHead& head, const LocalSpacing& spacing);
  [[nodiscard]] bool may_go_on(const LineHead& head, const ProximityHit& hit,
                               const LocalSpacing& spacing, double narrows_arc) const;
  void turn_back(const Narrows& narrows, LineHead& head, HalfLine& half);
  bool meets_corner(const LineHead& head, ProximityQuery query, HalfLine& half);
  void trace_half(LineHead head, bool may_close, double stop_fraction, HalfLine& half);
  std::optional<Halves> trace_halves(const Seed& seed, double stop_fraction);
  [[nodiscard]] bool is_arc_among_rings(const Halves& halves) const;
  double widest_gap(const HalfLine& half);
  std::optional<Halves> trace_ring(const Seed& seed, const Halves& arc);
  bool finish(const Seed& seed, const Halves& halves, LineDraft& draft) const;

  const TraceDomain& domain_;
  TracerSettings settings_;
  const FinishedLines& finished_;
  ProximityProbe proximity_;
  LineWalker walker_;
  std::vector<CoveredDisc> covered_;
};

}  // namespace strake
