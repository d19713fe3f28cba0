#pragma once

#include <cstdint>

#include "common/core/report.h"
#include "stages/evaluate/measured_surface.h"

namespace strake::evaluation {

/// Two surfaces, and how large the cells of the candidate are.
struct ThicknessRequest {
  const MeasuredSurface& reference;
  const MeasuredSurface& candidate;
  Vec3 origin = Vec3::Zero();  ///< of both, in the coordinates of the file
  double diagonal = 0;         ///< of the reference, model units
  double cell = 0;             ///< mean length, model units; positive
  std::int64_t samples = 0;    ///< on the reference; positive
};

/// Reports "thickness.*" of parts thinner than cells are long, and warns where they are not as
/// thick as they were: a stem that few cells flatten is off by less than they are long.
///
/// From samples of the reference one looks through the body to its other side. What that became
/// lies between the nearest places of the candidate that face the same ways, along the same line:
/// so a sheet that both sides leave alike and a rod that few cells bend keep their thickness. Both
/// sides are of one component, as parts may touch or lie in each other.
void report_thickness(const ThicknessRequest& request, Report& report);

}  // namespace strake::evaluation
