#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "tensor-part": the tensors of one part of a mesh, in less memory than all of it.
Stage tensor_part_stage();

}  // namespace strake
