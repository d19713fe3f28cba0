#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// The edges of a cell, by the corners they start at, that get a vertex to cut it across the
/// direction in which it is bent; where the bend does not explain its error, across the longer way.
/// \param corners   four or more, in order
/// \param bend      of the surface over the cell, 1/length, as CellError::bend states
/// \param distance  that the cell is off by
std::vector<std::size_t> edges_across_bend(std::span<const Vec3> corners, const Mat3& bend,
                                           double distance);

}  // namespace strake
