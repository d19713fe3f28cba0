#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace strake {

/// What the `mtllib` statements of an OBJ file are to say in a file in another folder, so that they
/// name the same files.
///
/// A statement may name several files, with blanks between; it names one with blanks in its name
/// where there is such a file.
/// \param statements  of the mesh file `from`
/// \param to  the other one
std::vector<std::string> material_files_seen_from(const std::vector<std::string>& statements,
                                                  const std::filesystem::path& from,
                                                  const std::filesystem::path& to);

}  // namespace strake
