#pragma once

#include <string>

#include "strake/run/yaml_view.h"

namespace strake {

/// Checks options of sbatch that the user adds: "--partition=long --account=geometry".
/// \return the text
/// \throw UsageError naming the place, where it is no list of options or sets what submission by
///        array depends on
std::string checked_sbatch_options(const std::string& text, const Place& place);

}  // namespace strake
