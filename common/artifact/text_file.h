#pragma once

#include <filesystem>
#include <string>

namespace strake {

/// Writes text to a file, whole or not at all. \throw InputError naming the file
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace strake
