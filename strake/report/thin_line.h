#pragma once

#include <cstdint>
#include <vector>

#include "common/core/types.h"

namespace strake::report {

/// Leaves out points of a polyline that it can do without (Douglas and Peucker 1973).
/// \param points    at least one
/// \param is_fixed  [points] not 0: has to stay; the first and the last one always stay
/// \return indices of the points that stay, ascending; all others are within `tolerance` of the
///         segment between the two kept points around them
std::vector<std::size_t> thin_line(const std::vector<Vec3>& points,
                                   std::vector<std::uint8_t> is_fixed, double tolerance);

}  // namespace strake::report
