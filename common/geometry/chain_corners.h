#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// The corners of a chain of points between which all of it is within a distance of straight pieces
/// (Ramer 1972, Douglas and Peucker 1973), without its ends, ascending.
std::vector<std::size_t> corners_of_chain(std::span<const Vec3> chain, double within);

}  // namespace strake
