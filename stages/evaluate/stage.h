#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "evaluate" as programs and engines run it, with options at their defaults.
Stage evaluate_stage();

}  // namespace strake
