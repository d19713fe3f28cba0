#pragma once

#include <filesystem>
#include <string>

#include "common/artifact/atomic_file.h"

namespace strake {

/// Writes text to a file, whole or not at all. \throw InputError naming the file
void write_text(const std::filesystem::path& path, const std::string& text,
                Flush flush = Flush::yes);

/// Writes text to a file that appears with its `commit`. \throw InputError naming the file
void write_text(AtomicFile& file, const std::string& text);

/// All of a file. \throw InputError naming the file where it cannot be read
std::string read_text(const std::filesystem::path& path);

}  // namespace strake
