#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stage "tensor-merge": all parts of a mesh to one tensor artifact, which is the one that the
/// stage "tensor" gives, byte for byte.
Stage tensor_merge_stage();

}  // namespace strake
