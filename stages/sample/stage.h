#pragma once

#include "common/stage/stage.h"

namespace strake {

/// Description of the stage: a surface of the program's own, with any of the samples' options.
Stage sample_stage();

}  // namespace strake
