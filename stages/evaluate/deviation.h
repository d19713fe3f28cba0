#pragma once

#include <cstdint>
#include <vector>

#include "common/core/observer.h"
#include "common/core/report.h"
#include "stages/evaluate/measured_surface.h"

namespace strake::evaluation {

/// A surface with the vertices that belong to it.
struct SurfaceWithVertices {
  const MeasuredSurface& surface;
  const std::vector<Vec3>& vertices;  ///< each one of a face with an area
};

/// The largest distance, model units, and the place it was measured from, on either surface.
struct Farthest {
  double distance = 0;
  Vec3 place = Vec3::Zero();
};

/// Reports "distance.*" and "normals.*": how far apart two surfaces are, both ways.
///
/// From each surface `samples` area-weighted places are taken to their nearest point on the other.
/// RMS and mean are over these; the maximum is over all vertices too, and over what is still
/// farther near the farthest places. A normal's deviation is the angle between the triangles'
/// normals at a sample and at its nearest point; on an edge or vertex the nearest of the normals
/// there. The combined RMS is the root of the mean of both squares, the combined mean the mean of
/// both.
/// \param samples  positive
/// \return the largest distance of both ways
Farthest report_deviation(const SurfaceWithVertices& reference,
                          const SurfaceWithVertices& candidate, double diagonal,
                          std::int64_t samples, Observer& observer, Report& report);

}  // namespace strake::evaluation
