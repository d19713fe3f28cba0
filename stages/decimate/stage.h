#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "decimate" as programs and engines run it, with options at their defaults.
Stage decimate_stage();

}  // namespace strake
