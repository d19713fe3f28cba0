#include "stages/smooth/cross_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <complex>

#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"
#include "stages/smooth/conjugate_gradients.h"

namespace strake {
namespace {

using Complex = std::complex<double>;

constexpr double kFeatureWeight = 100;  ///< against Dirichlet weights of order one
constexpr double kBoundaryWeight = 5;  ///< scan boundaries are ragged: follow, but not at any price

/// Half the cotangent of the angle opposite to half-edge h, kept within bounds that slivers would
/// leave: the weight of the edge in the Dirichlet energy, as far as this face is concerned.
double dirichlet_weight(const TriMesh& mesh, Index h) {
  const Vec3& apex = mesh.positions[mesh.from(TriMesh::prev(h))];
  const Vec3 a = mesh.positions[mesh.from(h)] - apex;
  const Vec3 b = mesh.positions[mesh.to(h)] - apex;
  const double cotangent = a.dot(b) / std::max(a.cross(b).norm(), 1e-9 * a.norm() * b.norm());
  return 0.5 * std::clamp(cotangent, 0.05, 5.0);
}

/// The linear system whose solution is the cross of every wedge, as cross_power in its own frame.
struct CrossSystem {
  HermitianMatrix matrix;
  std::vector<Complex> right;
};

CrossSystem cross_system(const TriMesh& mesh, const WedgeGraph& graph,
                         const std::vector<double>& areas, double stiffness,
                         const PrincipalField& field, std::vector<Complex>& principal) {
  const auto n = static_cast<std::size_t>(graph.size());
  std::vector<TangentFrame> frames(n);
  tbb::parallel_for(Index{0}, graph.size(), [&](Index w) {
    frames[w] = tangent_frame(field.normal[w]);
    principal[w] = cross_power(frames[w].tangent_from_world(field.t_min[w]));
  });
  CrossSystem system = {{graph.offsets, graph.neighbours,
                         std::vector<Complex>(graph.neighbours.size()), std::vector<double>(n)},
                        std::vector<Complex>(n)};
  tbb::parallel_for(Index{0}, graph.size(), [&](Index w) {
    const double bend = (field.k_max[w] - field.k_min[w]) * field.wedge_confidence[w];
    double held = stiffness * bend * bend * areas[w];  // to a direction
    Complex target = held * principal[w];
    double diagonal = 0;
    for (Index at = graph.offsets[w]; at < graph.offsets[w + 1]; ++at) {
      const Index h = graph.halfedges[at];
      const Index other = graph.neighbours[at];
      const Vec3 edge = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
      const Complex here = cross_power(frames[w].tangent_from_world(edge));
      const Complex there = cross_power(frames[other].tangent_from_world(edge));
      double weight = dirichlet_weight(mesh, h);
      if (mesh.is_barrier(h)) {
        const double hold = mesh.is_boundary(h) ? kBoundaryWeight : kFeatureWeight;
        held += hold;
        target += hold * here;
      } else {
        weight += dirichlet_weight(mesh, mesh.twin[h]);
      }
      diagonal += weight;
      system.matrix.values[at] = -weight * here * std::conj(there);
    }
    // A trace of weight everywhere keeps components without any reliable direction solvable.
    const double trace = 1e-9 * std::max(diagonal, 1e-30);
    system.matrix.diagonal[w] = diagonal + held + trace;
    system.right[w] = target + trace * principal[w];
  });
  return system;
}

}  // namespace

Index extend_cross_field(const TriMesh& mesh, const WedgeGraph& graph,
                         const std::vector<double>& areas, double stiffness,
                         PrincipalField& field) {
  std::vector<Complex> solution(static_cast<std::size_t>(graph.size()));
  const CrossSystem system = cross_system(mesh, graph, areas, stiffness, field, solution);
  const Index iterations = solve(system.matrix, system.right, {}, solution);

  field.cross.resize(solution.size());
  tbb::parallel_for(Index{0}, graph.size(), [&](Index w) {
    const TangentFrame frame = tangent_frame(field.normal[w]);
    const Vec2 principal = frame.tangent_from_world(field.t_min[w]);
    const double size = std::norm(solution[w]);
    const bool usable = std::isfinite(size) && size > 0;
    const Vec2 arm = usable ? cross_arm(solution[w], principal) : principal;
    field.cross[w] = frame.world_from_tangent(arm).normalized();
  });
  field.cross_extended = true;
  return iterations;
}

}  // namespace strake
