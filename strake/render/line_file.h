#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Polylines with the group each belongs to.
struct Polylines {
  std::vector<Vec3> positions;
  struct Line {
    std::vector<Index> points;
    std::string group;
    double width = 1;  ///< beside other lines
  };
  std::vector<Line> lines;
};

/// Reads the `v`, `l` and `g` records of an OBJ file; others are passed over.
/// \throw InputError naming file and line where a record is malformed or nothing is found
Polylines read_polylines(const std::filesystem::path& path);

}  // namespace strake
