#pragma once

#include <algorithm>
#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/topology/topology.h"

namespace strake {

/// Least cosine between the normals of two faces that are the same place of a surface, not on two
/// sheets of it near each other.
inline constexpr double kSameSheet = 0.5;

/// Tells whether faces are of one component: what is sought near a place of a part is not on
/// another part that lies in it or beside it.
class OwnComponent {
 public:
  explicit OwnComponent(const TriMesh& mesh) : component_(face_components(mesh)) {
    if (std::ranges::count(component_, 0) == std::ssize(component_)) component_.clear();
  }

  [[nodiscard]] bool has_both(Index face, Index other) const {
    return component_.empty() || component_[face] == component_[other];
  }
  [[nodiscard]] bool is_all() const { return component_.empty(); }

 private:
  std::vector<Index> component_;  ///< [F] empty where there is one
};

}  // namespace strake
