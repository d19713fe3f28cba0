#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "coarsen" as programs and engines run it, with options at their defaults.
Stage coarsen_stage();

}  // namespace strake
