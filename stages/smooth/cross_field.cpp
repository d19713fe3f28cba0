#include "stages/smooth/cross_field.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <complex>

#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"

namespace strake {
namespace {

using Complex = std::complex<double>;

constexpr double kFeatureWeight = 100;  ///< against Dirichlet weights of order one
constexpr double kBoundaryWeight = 5;  ///< scan boundaries are ragged: follow, but not at any price
constexpr double kTolerance = 1e-5;
constexpr int kMaxIterations = 2000;

/// Cotangent of the angle opposite to half-edge h, kept within bounds that slivers would leave.
double bounded_cotangent(const TriMesh& mesh, Index h) {
  const double angle = corner_angle(mesh, TriMesh::prev(h));
  return std::clamp(std::cos(angle) / std::max(std::sin(angle), 1e-9), 0.05, 5.0);
}

}  // namespace

Index extend_cross_field(const TriMesh& mesh, const std::vector<double>& areas, double stiffness,
                         PrincipalField& field) {
  const Index n = mesh.wedge_count();
  std::vector<TangentFrame> frames(n);
  for (Index w = 0; w < n; ++w) frames[w] = tangent_frame(field.normal[w]);

  std::vector<double> weight(n, 0);
  std::vector<Complex> target(n, Complex(0, 0));
  for (Index w = 0; w < n; ++w) {
    const double bend = (field.k_max[w] - field.k_min[w]) * field.wedge_confidence[w];
    weight[w] = stiffness * bend * bend * areas[w];
    target[w] = weight[w] * cross_power(frames[w].tangent_from_world(field.t_min[w]));
  }

  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(static_cast<std::size_t>(mesh.halfedge_count()) * 2 + n);
  std::vector<double> diagonal(n, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index i = mesh.wedge_of(h);
    const Index j = mesh.wedge_of(TriMesh::next(h));
    const Vec3 edge = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
    const Complex at_i = cross_power(frames[i].tangent_from_world(edge));
    const Complex at_j = cross_power(frames[j].tangent_from_world(edge));
    const double dirichlet = 0.5 * bounded_cotangent(mesh, h);
    diagonal[i] += dirichlet;
    diagonal[j] += dirichlet;
    const Complex j_from_i = at_j * std::conj(at_i);
    entries.emplace_back(j, i, -dirichlet * j_from_i);
    entries.emplace_back(i, j, -dirichlet * std::conj(j_from_i));
    if (mesh.is_barrier(h)) {
      const double w = mesh.is_boundary(h) ? kBoundaryWeight : kFeatureWeight;
      weight[i] += w;
      weight[j] += w;
      target[i] += w * at_i;
      target[j] += w * at_j;
    }
  }
  Eigen::VectorXcd right(n);
  Eigen::VectorXcd guess(n);
  for (Index w = 0; w < n; ++w) {
    // A trace of weight everywhere keeps components without any reliable direction solvable.
    const double trace = 1e-9 * std::max(diagonal[w], 1e-30);
    entries.emplace_back(w, w, Complex(diagonal[w] + weight[w] + trace, 0));
    const Complex own = cross_power(frames[w].tangent_from_world(field.t_min[w]));
    right[w] = target[w] + trace * own;
    guess[w] = own;
  }
  Eigen::SparseMatrix<Complex> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<Complex>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(kMaxIterations);
  solver.compute(matrix);
  const Eigen::VectorXcd solution = solver.solveWithGuess(right, guess);

  field.cross.resize(n);
  for (Index w = 0; w < n; ++w) {
    const Vec2 principal = frames[w].tangent_from_world(field.t_min[w]);
    const bool usable = std::isfinite(std::norm(solution[w])) && std::norm(solution[w]) > 0;
    const Vec2 arm = usable ? cross_arm(solution[w], principal) : principal;
    field.cross[w] = frames[w].world_from_tangent(arm).normalized();
  }
  field.cross_extended = true;
  return static_cast<Index>(solver.iterations());
}

}  // namespace strake
