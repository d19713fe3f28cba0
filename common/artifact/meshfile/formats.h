#pragma once

#include <string_view>
#include <vector>

#include "common/artifact/meshfile/mesh_reader.h"

/// One parser per format, internal to the reader. Each returns all vertices and faces as in the
/// file, with kNone for corners whose index cannot be valid, and colours as they stand there;
/// `read_mesh` checks, scales and compacts.
/// All throw InputError, without the file's name, where nothing can be made of the bytes.
namespace strake::meshfile {

PolyMesh read_obj(std::string_view bytes, ReadReport& report);
PolyMesh read_ply(std::string_view bytes, ReadReport& report);
PolyMesh read_off(std::string_view bytes, ReadReport& report);
PolyMesh read_stl(std::string_view bytes, ReadReport& report);

/// Whether a PLY property of faces that is an integer says which part they belong to: label,
/// labels, segment, segment_id, region, group, part, patch, material, material_index, object,
/// category, and what our own writer names after OBJ: o, g, usemtl.
bool is_label_name(std::string_view name);

/// Brings colours to shares of 1. Where red, green or blue is 2 or more they go from 0 to 255, and
/// likewise alpha; shares may be a little above 1. What is no finite number becomes 1.
void finish_colours(std::vector<Colour>& colours);

/// Whether the bytes are an STL file; binary ones are told by their size.
bool looks_like_stl(std::string_view bytes);
bool looks_like_binary_stl(std::string_view bytes);
/// Whether the bytes begin with one of the magic words of OFF.
bool looks_like_off(std::string_view bytes);
/// Whether an OBJ vertex or face line is among the first lines.
bool looks_like_obj(std::string_view bytes);

/// Narrows an index of a file; kNone where it cannot be the index of a vertex.
inline Index to_index(std::int64_t value) {
  return value >= 0 && value <= INT32_MAX ? static_cast<Index>(value) : kNone;
}

/// \throw InputError where vertices or corners exceed what an Index can count
void check_countable(std::size_t count, const char* what);

}  // namespace strake::meshfile
