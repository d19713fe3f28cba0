#pragma once

#include <cstdint>

#include "common/core/line_set.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// What lines make vertices of.
struct LineCount {
  std::int64_t crossings = 0;    ///< of two lines inside the surface, in the interior of a face
  std::int64_t on_barriers = 0;  ///< places on feature and boundary edges, but for their vertices
  std::int64_t corners = 0;      ///< of the mesh's feature and boundary lines

  /// Vertices of the mesh that these lines give, about: of 122 models and counts as many as were
  /// made on average, with a standard deviation of a tenth.
  [[nodiscard]] std::int64_t vertices() const { return crossings + on_barriers + corners; }
};

/// Counts the places where lines of curvature cross each other and feature and boundary lines.
/// Cost O(P log P + k^2) for P points, k of them in the fullest face.
LineCount count_places(const TriMesh& mesh, const LineSet& lines);

/// The factor on all distances at which lines would give as many vertices as wanted: crossings are
/// inverse to its square, places on feature and boundary lines to itself, and corners stay.
/// \param wanted  positive
/// \return from 1/4 to 4
double scale_for(const LineCount& count, double wanted);

}  // namespace strake
