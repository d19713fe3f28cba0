#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "mesh" as programs and engines run it, with options at their defaults.
Stage mesh_stage();

}  // namespace strake
