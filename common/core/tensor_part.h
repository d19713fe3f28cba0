#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Curvature tensors of some wedges of a TriMesh: one of several parts that make a TensorField.
struct TensorPart {
  std::string mesh_id;
  Index part = 1;   ///< number of this part, from 1
  Index parts = 1;  ///< that the mesh is divided into

  std::vector<Index> wedge;                   ///< [n] of the mesh, ascending
  std::vector<Vec3> position;                 ///< [n] of the wedge's vertex, for viewers
  std::vector<std::array<double, 6>> tensor;  ///< [n] as TensorField::tensor
  std::vector<Vec3> normal;                   ///< [n] as TensorField::normal
};

}  // namespace strake
