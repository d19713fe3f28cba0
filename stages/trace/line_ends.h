#pragma once

#include "common/geometry/angles.h"
#include "stages/trace/half_line.h"

namespace strake {

/// How directly a line must head for where it is to end, as a cosine: largest angle between its
/// heading and the way to a corner, or to its start, and then also the direction it started in.
const double kAheadCosine = std::cos(25 * kDegree);
/// The same for its start where the line would end otherwise.
const double kAheadCosineLast = std::cos(40 * kDegree);

/// Whether the head has come so far that its start, when near, is one to come back to.
bool can_close(const LineHead& head, const LocalSpacing& spacing);

/// Closes a line that comes back to its start: goes straight to the first point near its seed that
/// a chord can reach, and drops the points before that one.
/// \param half  changed only where it closes; then `end` is `closed` and the chord from its last
///              point to its first lies in `faces.front()`
bool close_line(const TraceDomain& domain, ProximityProbe& proximity, LineWalker& walker,
                const LineHead& head, double least_cosine, HalfLine& half);

/// Ends a line at a corner of feature or boundary lines that it heads for: goes straight to it.
/// \param corner  a vertex
/// \return false, and nothing changes, where no chords lead there
bool end_at_corner(const TraceDomain& domain, LineWalker& walker, const LineHead& head,
                   Index corner, HalfLine& half);

}  // namespace strake
