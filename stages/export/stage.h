#pragma once

#include "common/stage/stage.h"

namespace strake {

/// Description of the stage: the mesh of a quads artifact as a mesh file.
Stage export_stage();

}  // namespace strake
