#pragma once

#include <filesystem>
#include <string>

namespace strake {

/// A path without `.` and `..`, as long as the system takes it for the same: not where what is
/// before `..` is a link to a folder elsewhere.
std::filesystem::path without_dots(const std::filesystem::path& path);

/// What keeps a path from being written into the files of a run, which are lines of UTF-8: "line
/// breaks or other control characters", or "characters that are no UTF-8"; empty: nothing.
std::string unfit_for_runs(const std::filesystem::path& path);

}  // namespace strake
