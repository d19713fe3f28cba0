#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "import" as programs and engines run it, with options at their defaults.
Stage import_stage();

}  // namespace strake
