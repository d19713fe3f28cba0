#pragma once

#include <array>
#include <vector>

#include "common/core/tri_mesh.h"
#include "common/core/types.h"
#include "common/geometry/face_crossings/box_tree.h"

namespace strake {

/// Edges of a mesh that lie in the same place as other ones, as non-manifold edges do that import
/// took apart: sheets touch there.
class SharedEdges {
 public:
  /// \param within  distance up to which something is on them, model units. Cost O(V log V)
  SharedEdges(const TriMesh& mesh, double within);

  [[nodiscard]] bool any() const { return !ends_.empty(); }
  /// Whether a point is on one. \param p  relative to the mesh's origin
  [[nodiscard]] bool hold(const Vec3& p) const;
  /// Whether the box around one touches a box. \param box  relative to the mesh's origin
  [[nodiscard]] bool are_near(const BoxTree::Box& box) const;

 private:
  double within_;
  std::vector<std::array<Vec3, 2>> ends_;
  BoxTree tree_;
};

}  // namespace strake
