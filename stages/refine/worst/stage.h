#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "refine-worst"; see stages/refine/worst.h.
Stage refine_worst_stage();

}  // namespace strake
