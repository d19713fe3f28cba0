#pragma once

#include <vector>

#include "common/core/types.h"

namespace strake {

/// A place on a chain of straight pieces: on piece i, from places[i] to places[i + 1].
struct WayPlace {
  std::size_t piece = 0;
  double share = 0;  ///< of the piece, in [0, 1]
};

/// Where a chain is best divided so that its two chords are near it: where it is farthest from its
/// one chord, if that is in the middle half and clearly farther than the middle, as at a ridge of a
/// coarse mesh; else in the middle by length.
/// \param places  at least 2
WayPlace split_of_way(const std::vector<Vec3>& places);

/// How far a chain is from its one chord at most, of a chain that is empty 0.
double height_of_way(const std::vector<Vec3>& places);

}  // namespace strake
