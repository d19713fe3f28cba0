#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Whether faces of different labels meet at an inner edge.
bool is_label_border(const TriMesh& mesh, Index halfedge);

/// Whether the two sides of an inner edge differ in texture coordinates, by more than 1e-6.
bool is_seam(const TriMesh& mesh, Index halfedge);

/// Where texture coordinates turn back, as where the two halves of a body share them: between would
/// be what is in neither.
class MirrorLines {
 public:
  /// \param mesh  kept by reference
  explicit MirrorLines(const TriMesh& mesh);

  /// Whether the faces at an inner edge have texture coordinates in opposite senses, both about as
  /// dense as usual: a projection turns back, too, but where it looks along the surface.
  [[nodiscard]] bool contains(Index halfedge) const;

 private:
  [[nodiscard]] double texture_area(Index face) const;

  const TriMesh& mesh_;
  std::vector<double> density_;  ///< [F] area of texture to area, in mean ones; negative: mirrored
};

}  // namespace strake::import
