#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "strake/run/run_folder.h"

namespace strake {

/// The folder that this program itself lies in: the programs of the stages lie beside it.
std::filesystem::path program_folder();

/// The command that a step comes to: the program's path, inputs, output, threads, and the options
/// that are not at their defaults.
/// \pre the files of the order's inputs and parts are filled in
std::vector<std::string> stage_command(const StepOrder& order, const std::filesystem::path& output);

}  // namespace strake
