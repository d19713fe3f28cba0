#pragma once

#include "common/stage/stage.h"

namespace strake {

/// Description of the stage: the result with its vertices where its faces lie nearest the surface.
Stage fit_stage();

}  // namespace strake
