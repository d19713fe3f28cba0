#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "restrict" as programs and engines run it, with options at their defaults.
Stage restrict_stage();

}  // namespace strake
