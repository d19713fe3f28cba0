#pragma once

#include <array>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// The constrained Delaunay triangulation of a polygon with holes, without further points.
/// \param points    [n] no two at the same place
/// \param outlines  points around the polygon, counter-clockwise, and around each hole, clockwise
/// \return corners of each triangle, counter-clockwise; nothing where the outlines cross or
///         overlap, or are not around one polygon
/// Cost: that of cutting ears off, about quadratic in the number of points.
std::vector<std::array<Index, 3>> triangulate_outlines(
    const std::vector<Vec2>& points, const std::vector<std::vector<Index>>& outlines);

}  // namespace strake
