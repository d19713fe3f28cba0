#pragma once

#include <array>
#include <functional>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Fills a closed polygon in space with triangles between its corners.
///
/// By dynamic programming (Liepa 2003, Filling Holes in Meshes): least is the sharpest turn between
/// neighbouring triangles and towards the faces around; then the area. Triangles with an angle
/// below 1 degree count as the sharpest turn.
/// \param corners   at least 3 places, any length unit
/// \param beyond    [n] unit normal of the face beyond the side that corner i begins; zero: none to
///                  keep to
/// \param may_join  whether there may be an edge between corners i < j that are not neighbours
/// \return n - 2 triangles of numbers of corners, in the sense of the polygon; none where edges may
/// not be. Cost O(n^3)
std::vector<std::array<Index, 3>> fill_polygon(
    const std::vector<Vec3>& corners, const std::vector<Vec3>& beyond,
    const std::function<bool(std::size_t, std::size_t)>& may_join);

}  // namespace strake
