#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "refine-uncross": the input's own faces where faces of a result cross.
Stage refine_uncross_stage();

}  // namespace strake
