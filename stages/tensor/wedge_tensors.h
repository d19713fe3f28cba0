#pragma once

#include <array>
#include <vector>

#include "common/core/observer.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Balls grow with the local edge length up to this multiple of the wanted radius: below one ring
/// of edges the estimate only sees single dihedral angles.
inline constexpr double kLargestGrowth = 3;

struct WedgeTensors {
  std::vector<std::array<double, 6>> tensor;  ///< [count] as TensorField::tensor
  std::vector<Vec3> normal;                   ///< [count] as TensorField::normal
  Index grown = 0;                            ///< balls that grew beyond the wanted radius
};

/// Estimates the tensors of the wedges 0 ... count - 1 of a mesh.
///
/// Of a wedge at p it reads: all faces of that wedge, the faces within kLargestGrowth * radius of
/// p, and where one of these is a sliver, the faces from which `face_normals` gives it a normal.
/// Sums run in the order of faces and corners, so a mesh that has these faces in the same order
/// gives the same bits.
/// \param radius  of the balls, model units
WedgeTensors estimate_wedge_tensors(const TriMesh& mesh, Index count, double radius,
                                    Observer& observer);

}  // namespace strake
