#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "tensor" as programs and engines run it, with options at their defaults.
Stage tensor_stage();

}  // namespace strake
