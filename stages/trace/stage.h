#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "trace" as programs and engines run it, with options at their defaults.
Stage trace_stage();

}  // namespace strake
