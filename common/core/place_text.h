#pragma once

#include <string>

#include "common/core/types.h"

namespace strake {

/// "(x, y, z)" of a place of a model, to be found again by, with as many digits as tell places
/// apart that are a ten-thousandth of its diagonal from each other, and at least four.
std::string place_text(const Vec3& place, double diagonal);

}  // namespace strake
