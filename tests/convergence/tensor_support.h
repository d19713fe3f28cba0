#pragma once

#include "common/core/fields.h"
#include "common/core/options.h"
#include "common/core/tri_mesh.h"
#include "tests/support/analytic_surfaces.h"

namespace strake::support {

/// Runs the tensor stage.
TensorField tensors(const TriMesh& mesh, Length radius);

/// The tensor of one wedge as a matrix.
Mat3 tensor_matrix(const TensorField& field, Index wedge);

/// What the normal-cycle tensor tends to: the larger |curvature| along the *minimum* direction.
Mat3 exact_tensor(const ExactCurvature& exact);

/// Principal curvatures and the direction of the minimum one, in the tangent plane of the normal.
struct Principal {
  double k_min, k_max;
  Vec3 t_min;
};
Principal principal(const Mat3& tensor, const Vec3& normal);

}  // namespace strake::support
