#pragma once

#include <string>
#include <vector>

#include "common/stage/stage.h"

namespace strake {

/// The programs a pipeline may use, in the order of the standard chain: "sample", "import",
/// "tensor", "smooth", "trace", "mesh", "fit", "evaluate", "export".
const std::vector<std::string>& stage_names();

/// A new description of a stage, with options of its own.
/// \pre the name is one of `stage_names`, or "tensor-part"
Stage make_stage(const std::string& name);

}  // namespace strake
