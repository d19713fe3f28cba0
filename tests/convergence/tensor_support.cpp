#include "tests/convergence/tensor_support.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "stages/tensor/tensor.h"

namespace strake::support {

TensorField tensors(const TriMesh& mesh, Length radius) {
  TensorOptions options;
  options.radius = radius;
  SilentObserver observer;
  return estimate_tensors(mesh, options, observer).field;
}

Mat3 tensor_matrix(const TensorField& field, Index wedge) {
  const auto& t = field.tensor[wedge];
  Mat3 m;
  m << t[0], t[1], t[2], t[1], t[3], t[4], t[2], t[4], t[5];
  return m;
}

Mat3 exact_tensor(const ExactCurvature& exact) {
  return exact.k_max * exact.t_min * exact.t_min.transpose() +
         exact.k_min * exact.t_max * exact.t_max.transpose();
}

Principal principal(const Mat3& tensor, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  Mat2 m;
  m << u.dot(tensor * u), u.dot(tensor * v), u.dot(tensor * v), v.dot(tensor * v);
  const Eigen::SelfAdjointEigenSolver<Mat2> solver(m);
  const Vec2 k = solver.eigenvalues();
  const int larger = std::abs(k[0]) > std::abs(k[1]) ? 0 : 1;
  const Vec2 direction = solver.eigenvectors().col(larger);
  return {k[1 - larger], k[larger], direction.x() * u + direction.y() * v};
}

}  // namespace strake::support
