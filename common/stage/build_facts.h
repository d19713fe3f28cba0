#pragma once

#include <string>

namespace strake {

/// What `PROGRAM --version` says: name and version on the first line, then compiler, build type and
/// the versions of libraries.
std::string version_text(const std::string& program);

}  // namespace strake
