#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "lift" as programs and engines run it, with options at their defaults.
Stage lift_stage();

}  // namespace strake
