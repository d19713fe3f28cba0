#pragma once

#include "common/stage/stage.h"

namespace strake {

/// Description of the stage: distances of lines from the errors of a result.
Stage size_stage();

}  // namespace strake
