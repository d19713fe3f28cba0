#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace strake {

/// Carries out one step of a run: checks its inputs, looks whether its result is in the store after
/// all, otherwise runs the stage's program and adds what it made to the store. What became of it is
/// written to the run folder; other steps go by that.
///
/// Safe to do twice, at once, and on several machines; safe to kill at any moment.
/// \param parent  number of the process that this one is to end with; 0: whoever started it
/// \return the exit code of the program, 0 on success
int execute_step(const std::filesystem::path& run_folder, const std::string& id,
                 std::int64_t parent);

}  // namespace strake
