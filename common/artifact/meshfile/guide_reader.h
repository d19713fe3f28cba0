#pragma once

#include <filesystem>
#include <string_view>

#include "common/core/guides.h"

namespace strake {

/// Reads guide lines: the line elements ("l") of an OBJ file, or the edges of a PLY file (element
/// "edge" with the properties vertex1 and vertex2), each a guide of its own. Faces and the like are
/// ignored.
/// \throw InputError naming the file and the vertex, line or edge at fault where there is no guide,
///        a coordinate is no finite number, or a vertex that is named does not exist
GuideLines read_guides(const std::filesystem::path& path);

/// As `read_guides`, from bytes in memory. \param name  of the file, for messages
GuideLines parse_guides(std::string_view bytes, const std::string& name);

}  // namespace strake
