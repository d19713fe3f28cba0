#pragma once

#include <filesystem>
#include <string_view>

#include "common/core/fields.h"

namespace strake {

/// Reads the vertex property "density" of a PLY file, ascii or binary.
/// \return one positive number per vertex, in the order of the file, and their places where it has
///         them
/// \throw InputError naming the file, and the vertex where one is at fault, where it is no PLY file,
///        has no such property, ends too early, or holds a density that is not a positive number
DensityField read_density(const std::filesystem::path& path);

/// As read_density, from bytes in memory; messages are without the file's name.
DensityField parse_density(std::string_view bytes);

}  // namespace strake
