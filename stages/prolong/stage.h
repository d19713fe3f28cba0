#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "prolong" as programs and engines run it, with options at their defaults.
Stage prolong_stage();

}  // namespace strake
