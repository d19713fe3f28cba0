#pragma once

#include <functional>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Joins triangles in pairs to quads, those with the best angles first.
///
/// A quad is convex, has angles of 20 to 160 degrees, and turns along its diagonal by less than 45.
/// \param triangles  of which no two have a side in common; the second of a pair goes
/// \param may_join   whether the edge between two vertices may go
void join_triangles(const std::vector<Vec3>& positions, std::vector<std::vector<Index>>& triangles,
                    const std::function<bool(Index, Index)>& may_join);

}  // namespace strake
