#pragma once

#include <string>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Polylines on or near a surface along which a user wants edges to run.
struct GuideLines {
  std::vector<std::vector<Vec3>> lines;  ///< two or more points each, model coordinates
  std::string name;                      ///< of the file, for messages
};

/// Guide lines as they lie on a mesh: each a run of short pieces, one after the other.
struct LaidGuides {
  /// [L + 1] guide l has the pieces offsets[l] .. offsets[l + 1] - 1
  std::vector<Index> offsets = {0};
  std::vector<Index> face;        ///< [P] in which the middle of the piece lies
  std::vector<Vec3> barycentric;  ///< [P] of the middle, in `face`
  std::vector<Vec3> step;         ///< [P] from the piece's begin to its end, in the plane of `face`

  [[nodiscard]] Index line_count() const { return static_cast<Index>(offsets.size()) - 1; }
  [[nodiscard]] Index piece_count() const { return offsets.back(); }
};

}  // namespace strake
