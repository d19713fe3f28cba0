#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "smooth" as programs and engines run it, with options at their defaults.
Stage smooth_stage();

}  // namespace strake
