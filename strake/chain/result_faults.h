#pragma once

#include <cstdint>

#include "common/geometry/face_crossings/crossing_places.h"
#include "strake/chain/counted.h"
#include "strake/chain/session.h"

namespace strake {

/// What is wrong with a result for a count. Lengths are in those of mean cells if there are as many
/// as wanted.
struct ResultFaults {
  double distance = 0;  ///< root mean square, times the share of the count: it falls with that
  double largest = 0;   ///< distance
  double crossing = 0;  ///< share of the faces
  double missing = 0;   ///< share of the count, more than one or two too few or too many
  double odd = 0;       ///< share of the faces that are no quads
  double thin = 0;      ///< share of the faces with an angle below 10 degrees
};

/// Samples of a result and of the surface, about; large cells hide much between few.
inline constexpr double kFaultSamples = 200000;

/// Measures what `result_port` names against "mesh". \param crossing  of that mesh
ResultFaults faults_of(const Session& session, Counted counted, std::int64_t wanted,
                       CrossingPlaces& crossing, double samples = kFaultSamples);

}  // namespace strake
