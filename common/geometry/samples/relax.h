#pragma once

#include "common/geometry/samples/random.h"
#include "common/geometry/samples/surface_builder.h"

namespace strake {

/// Improves the triangles of a draft: Delaunay edge flips and tangential smoothing in turns. Free
/// vertices slide on their surfaces, fixed ones and locked edges stay.
/// \pre the draft's faces form an oriented manifold
void relax(SurfaceDraft& draft, int rounds);

/// Displaces free vertices at random along their surfaces, by up to a share of the shortest edge
/// around, then flips edges to Delaunay. Moves that would spoil a triangle are left out.
/// \param amount  in [0, 1]
void scatter(SurfaceDraft& draft, double amount, UniformRandom& random);

}  // namespace strake
