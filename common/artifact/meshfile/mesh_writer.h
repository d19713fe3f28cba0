#pragma once

#include <filesystem>

#include "common/core/poly_mesh.h"

namespace strake {

/// Writes a polygon mesh as OBJ, PLY (binary little-endian) or OFF, as the extension says.
///
/// With its attributes, except in OFF: colours, texture coordinates and labels are written as
/// `read_mesh` reads them. PLY holds colours in steps of 1/255 and texture coordinates in single
/// precision, and names of labels as comments only.
///
/// Coordinates keep their full double precision. The file appears complete or not at all, and a
/// file that holds the same bytes already is left alone.
/// \throw UsageError where the extension is none of .obj, .ply, .off
/// \throw InputError naming the path and the reason where the file cannot be written
void write_mesh(const std::filesystem::path& path, const PolyMesh& mesh);

}  // namespace strake
