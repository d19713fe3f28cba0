#pragma once

#include <vector>

#include "stages/trace/line_head.h"
#include "stages/trace/proximity.h"

namespace strake {

/// Places along a half line where lines that cross it could start.
class CrossingSeeds {
 public:
  /// Remembers where the head is now, `step` (model units) after it was asked last.
  /// \param distance wanted between the lines that cross, model units
  void note(const TraceDomain& domain, const LineHead& head, double distance, double step);

  /// Adds seeds at their wanted distances from the line's own seed on; evenly spread where the line
  /// is closed.
  void spawn(bool closed, std::vector<Seed>& spawned) const;

  /// Forgets all but the first `count` places.
  void shorten(std::size_t count);

  /// All places, one per step.
  [[nodiscard]] const std::vector<Seed>& all() const { return seeds_; }

 private:
  std::vector<Seed> seeds_;
  std::vector<double> measures_;  ///< where they lie, in units of the wanted distance
  double measure_ = 0;
};

/// How far it is to the lines beside a head, of its direction.
struct LineGap {
  double to_left = 0;   ///< model units, at most `reach`
  double to_right = 0;  ///< likewise
  double wanted = 0;    ///< between neighbouring lines here
  double reach = 0;     ///< how far was looked
};
LineGap gap_beside(const TraceDomain& domain, const LineHead& head, ProximityProbe& proximity);

/// How far it is to the nearest of them, as a share of the wanted distance: at most 2, which is how
/// far is looked. Much cheaper where it is near.
double share_to_nearest(const TraceDomain& domain, const LineHead& head, ProximityProbe& proximity);

/// The seed moved sideways into the middle between the lines of its direction beside it, or to
/// the wanted distance from the only one: lines that fill gaps are then as even as possible.
Seed centred(const TraceDomain& domain, const Seed& seed, ProximityProbe& proximity);

}  // namespace strake
