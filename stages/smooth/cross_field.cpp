#include "stages/smooth/cross_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <complex>

#include "common/geometry/angles.h"
#include "common/geometry/border_course.h"
#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"
#include "stages/smooth/hermitian_matrix.h"

namespace strake {
namespace {

using Complex = std::complex<double>;

constexpr double kFeatureWeight = 100;  ///< against Dirichlet weights of order one
constexpr double kGuideWeight = 100;    ///< likewise, on the faces that a guide passes
constexpr double kBoundaryWeight = 5;  ///< scan boundaries are ragged: follow, but not at any price
constexpr double kLossAngle = 10 * kDegree;  ///< of the loss of Geman and McClure
constexpr int kReweightings = 6;
/// Over this share of the diagonal crosses of length one spread at first, and over how much less in
/// each round after it.
constexpr double kFirstSpread = 0.3;
constexpr double kLessSpread = 0.5;
constexpr int kSpreadings = 6;
/// When a solve is good enough, as a share of the holds to principal directions. What features and
/// guides add to the right side says nothing about how far the rest has come.
constexpr double kTolerance = 1e-3;
constexpr double kRoughTolerance = 1e-2;  ///< likewise, of solves that only give weights
/// As a share of the whole right side it need not be less than this share of the tolerance.
constexpr double kLeastShare = 1e-2;

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
  HermitianMatrix matrix;          ///< its diagonal is that of the solve at hand
  std::vector<double> diagonal;    ///< [W] without the hold to principal directions
  std::vector<Complex> right;      ///< [W] likewise
  std::vector<Complex> principal;  ///< [W] what is held to
  std::vector<double> hold;        ///< [W] how strongly, where the loss is quadratic
  std::vector<double> areas;       ///< [W] as shares of the squared diagonal
};

/// What the solves share that follow each other.
struct Workspace {
  std::vector<double> holds;
  SolverVectors<Complex> solver;
};

CrossSystem cross_system(const TriMesh& mesh, const WedgeGraph& graph, double stiffness,
                         const GuidePull& guides, const PrincipalField& field) {
  const auto n = static_cast<std::size_t>(graph.size());
  std::vector<TangentFrame> frames(n);
  const std::vector<Index> halfedges = graph_halfedges(mesh, graph);
  const std::vector<Vec3> ragged = ragged_directions(mesh);
  CrossSystem system = {
      {graph.offsets, graph.neighbours, std::vector<std::complex<float>>(graph.neighbours.size()),
       std::vector<double>(n)},
      std::vector<double>(n),
      std::vector<Complex>(n),
      std::vector<Complex>(n),
      std::vector<double>(n),
      wedge_areas(mesh)};
  const double diagonal2 = mesh.diagonal * mesh.diagonal;
  for (double& area : system.areas) area /= diagonal2;
  tbb::parallel_for(Index{0}, graph.size(), [&](Index w) {
    frames[w] = tangent_frame(field.normal[w]);
    system.principal[w] = cross_power(frames[w].tangent_from_world(field.t_min[w]));
    const double confidence = field.wedge_confidence[w];
    system.hold[w] = stiffness * mesh.diagonal * confidence * confidence *
                     std::abs(field.k_max[w] - field.k_min[w]) * system.areas[w];
    if (guides.distance.empty() || guides.distance[w] == 1) return;
    system.principal[w] = cross_power(frames[w].tangent_from_world(guides.direction[w]));
    system.hold[w] *= 1 - guides.distance[w];
  });
  tbb::parallel_for(Index{0}, graph.size(), [&](Index w) {
    double diagonal = 0;
    for (Index at = graph.offsets[w]; at < graph.offsets[w + 1]; ++at) {
      const Index h = halfedges[at];
      const Index other = graph.neighbours[at];
      const Vec3 edge = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
      const Complex here = cross_power(frames[w].tangent_from_world(edge));
      const Complex there = cross_power(frames[other].tangent_from_world(edge));
      double weight = dirichlet_weight(mesh, h);
      if (mesh.is_barrier(h)) {
        const double hold = mesh.is_boundary(h) ? kBoundaryWeight : kFeatureWeight;
        diagonal += hold;
        const Index v = mesh.wedge_vertex[w];
        const bool is_saw = mesh.is_boundary(h) && !ragged.empty() && !ragged[v].isZero(0);
        const Vec3& along = is_saw ? ragged[v] : edge;
        system.right[w] += hold * cross_power(frames[w].tangent_from_world(along));
      } else {
        weight += dirichlet_weight(mesh, mesh.twin[h]);
      }
      const std::complex<float> value(-weight * (here * std::conj(there)));
      system.matrix.values[at] = value;
      diagonal += std::abs(Complex(value));  // so rounding leaves no negative eigenvalue
    }
    if (!guides.distance.empty() && guides.distance[w] == 0) {
      diagonal += kGuideWeight;
      system.right[w] += kGuideWeight * system.principal[w];
    }
    // A trace of weight everywhere keeps components without any reliable direction solvable.
    const double trace = 1e-9 * std::max(diagonal, 1e-30);
    system.diagonal[w] = diagonal + trace;
    system.right[w] += trace * system.principal[w];
  });
  return system;
}

/// Solves for the crosses with each hold weakened as the loss wants it at the angle between
/// the last solution and the principal direction; not at all where `solution` is that direction.
/// \param inertia  times the area of each cross it holds to the last one, made one long
Index solve_reweighted(CrossSystem& system, double inertia, double tolerance,
                       std::vector<Complex>& solution, Workspace& space) {
  std::vector<Complex>& right = space.solver.right;
  std::vector<double>& holds = space.holds;
  right.resize(solution.size());
  holds.resize(solution.size());
  tbb::parallel_for(Index{0}, static_cast<Index>(solution.size()), [&](Index w) {
    const double angle = std::arg(solution[w] * std::conj(system.principal[w])) / 4;
    const double share = 1 / (1 + angle * angle / (kLossAngle * kLossAngle));
    const double hold = system.hold[w] * share * share;
    holds[w] = hold;
    system.matrix.diagonal[w] = system.diagonal[w] + hold;
    right[w] = system.right[w] + hold * system.principal[w];
    const double length = std::abs(solution[w]);
    if (inertia == 0 || length == 0) return;
    system.matrix.diagonal[w] += inertia * system.areas[w];
    right[w] += inertia * system.areas[w] / length * solution[w];
  });
  double hold_norm2 = 0;
  double right_norm2 = 0;
  for (std::size_t w = 0; w < solution.size(); ++w) {
    hold_norm2 += holds[w] * holds[w];
    right_norm2 += std::norm(right[w]);
  }
  const double share = right_norm2 > 0 ? std::sqrt(hold_norm2 / right_norm2) : 1;
  const SolverOptions options = {.tolerance = tolerance * std::clamp(share, kLeastShare, 1.0)};
  return solve(system.matrix, options, solution, space.solver);
}

/// [W] the crosses.
/// \param iterations  of all solves, are added to
///
/// The linear systems let crosses shrink where nothing holds them: on a disk, to nothing in the
/// middle, where all of its four singular places then are. Making them one long and letting them
/// spread, ever less, comes to the best places for these (0.85 radii from the middle of the disk).
/// Diffusion with thresholds, after Viertel and Osting 2019.
std::vector<Complex> solve_crosses(CrossSystem system, Index& iterations) {
  Workspace space;
  std::vector<Complex> solution = system.principal;
  for (int round = 0; round <= kReweightings; ++round) {
    const double tolerance = round < kReweightings ? kRoughTolerance : kTolerance;
    iterations += solve_reweighted(system, 0, tolerance, solution, space);
  }
  double spread = kFirstSpread;
  for (int round = 0; round < kSpreadings; ++round, spread *= kLessSpread) {
    iterations += solve_reweighted(system, 1 / (spread * spread), kTolerance, solution, space);
  }
  return solution;
}

/// [W] one arm of each cross, in space; the principal direction where there is none.
std::vector<Vec3> arms_of(const std::vector<Complex>& crosses, const PrincipalField& field) {
  std::vector<Vec3> arms(crosses.size());
  tbb::parallel_for(Index{0}, static_cast<Index>(crosses.size()), [&](Index w) {
    const TangentFrame frame = tangent_frame(field.normal[w]);
    const Vec2 principal = frame.tangent_from_world(field.t_min[w]);
    const double size = std::norm(crosses[w]);
    const bool usable = std::isfinite(size) && size > 0;
    const Vec2 arm = usable ? cross_arm(crosses[w], principal) : principal;
    arms[w] = frame.world_from_tangent(arm).normalized();
  });
  return arms;
}

}  // namespace

Index extend_cross_field(const TriMesh& mesh, const WedgeGraph& graph, double stiffness,
                         const GuidePull& guides, PrincipalField& field) {
  Index iterations = 0;
  field.cross = arms_of(
      solve_crosses(cross_system(mesh, graph, stiffness, guides, field), iterations), field);
  field.cross_extended = true;
  return iterations;
}

}  // namespace strake
