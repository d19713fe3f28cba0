#pragma once

#include "common/stage/stage.h"

namespace strake {

/// Description of the stage: the result with those cells divided that are too far from the surface.
Stage refine_stage();

}  // namespace strake
