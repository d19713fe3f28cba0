#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace strake {

/// XXH3-128 of a file's bytes as 32 hexadecimal digits: names contents, is no proof against malice.
/// \throw InputError where the file cannot be read
std::string digest_file(const std::filesystem::path& path);

/// The same of a text in memory.
std::string digest_text(std::string_view text);

}  // namespace strake
