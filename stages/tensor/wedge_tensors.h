#pragma once

#include <array>
#include <vector>

#include "common/core/observer.h"
#include "common/core/tri_mesh.h"
#include "stages/tensor/tensor.h"

namespace strake {

/// Balls grow with the local edge length up to this multiple of the wanted radius: below one ring
/// of edges the estimate only sees single dihedral angles.
inline constexpr double kLargestGrowth = 3;

/// Which balls are wanted. One of more faces than `most_faces` shrinks, but not below one ring of
/// edges.
struct BallRule {
  double radius;             ///< model units
  Index most_faces = kNone;  ///< kNone: no ball shrinks
};

/// Radius of the averaging balls, and how many faces they hold.
///
/// Where no radius is asked for it is 1 % of the diagonal. Beyond two million faces it falls with
/// their edges, so that a ball does not hold more and more of them: time would grow with their
/// square, to average away what such a scan shows. Nor does a ball hold more than some thousand
/// faces, as it would where most of a mesh is small against its diagonal.
/// \param diagonal  of the bounding box, model units
BallRule ball_rule(const TensorOptions& options, double diagonal, Index faces);

struct WedgeTensors {
  std::vector<std::array<double, 6>> tensor;  ///< [wedges] as TensorField::tensor
  std::vector<Vec3> normal;                   ///< [wedges] as TensorField::normal
  Index grown = 0;                            ///< balls that grew beyond the wanted radius
  Index shrunk = 0;                           ///< balls that shrank to hold fewer faces
};

/// Estimates the tensors of some wedges of a mesh, in their order.
///
/// Of a wedge at p it reads: all faces of that wedge, the faces within kLargestGrowth * radius of
/// p, and where one of these is a sliver, the faces from which `face_normals` gives it a normal.
/// Sums run in the order of faces and corners, so a mesh that has these faces in the same order
/// gives the same bits.
WedgeTensors estimate_wedge_tensors(const TriMesh& mesh, const std::vector<Index>& wedges,
                                    const BallRule& rule, Observer& observer);

}  // namespace strake
