#include "stages/size/size.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/density.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/poly_topology/poly_edges.h"

namespace strake {
namespace {

/// Power of the error with which distances change. The error grows with the square e = c d^2 of the
/// distance d, so for a count its square sums up to the least where d goes with c^(-1/3): cells far
/// from the surface shrink, but stay the farthest.
constexpr double kFeedback = 0.33;
/// With a density, which says by itself how many vertices go where: nearly all at once.
constexpr double kFeedbackOfDensity = 0.4;
/// Cells are averaged over their neighbours, so that few samples of each do; not with a density,
/// which a result follows by the few lines that it is more or less.
constexpr CellSampling kFewSamples = {.rows = 3, .input_step = 1.0 / 3};
/// Limits of the change of a distance.
constexpr double kLargestShrink = 0.6;
constexpr double kLargestGrowth = 1.25;
/// Times that cells take the mean of themselves and their neighbours.
constexpr int kAveraging = 3;
/// A cell whose error is more times that of its surroundings asks for closer lines by itself.
constexpr double kOutlier = 3;
/// Share of a cell's bending that one direction has at least and at most.
constexpr double kLeastShare = 0.2;
constexpr double kSmallestError = 1e-7;  ///< share of the diagonal

/// A value of each cell, averaged over neighbours across edges.
template <class T>
void average(const std::vector<std::array<Index, 2>>& neighbours, std::vector<T>& values) {
  for (int round = 0; round < kAveraging; ++round) {
    std::vector<T> sum = values;
    std::vector<double> count(values.size(), 1);
    for (const auto& [a, b] : neighbours) {
      sum[a] += values[b];
      sum[b] += values[a];
      ++count[a];
      ++count[b];
    }
    for (std::size_t f = 0; f < values.size(); ++f) values[f] = sum[f] / count[f];
  }
}

/// [F] pairs of cells with a common edge.
std::vector<std::array<Index, 2>> neighbour_cells(const PolyMesh& faces) {
  const PolyEdges edges = collect_edges(faces);
  std::vector<std::array<Index, 2>> pairs;
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const std::span<const Index> sides = edges.sides_of(e);
    if (sides.size() != 2) continue;
    pairs.push_back({edges.corner_face[sides[0]], edges.corner_face[sides[1]]});
  }
  return pairs;
}

/// Errors of cells and how the surface bends away from them, averaged.
struct Averaged {
  std::vector<double> log_error;  ///< [F] of the error as a share of the diagonal
  std::vector<Mat3> bend;         ///< [F]
};

Averaged averaged_errors(const PolyMesh& faces, const ErrorMap& errors, double diagonal) {
  Averaged result;
  for (const CellError& cell : errors.cells) {
    // Between the two measures: one spot should not decide for a cell, nor be lost in it.
    const double error = std::sqrt(cell.rms * cell.largest) / diagonal;
    result.log_error.push_back(std::log(std::max(error, kSmallestError)));
    result.bend.push_back(cell.bend);
  }
  const std::vector<std::array<Index, 2>> neighbours = neighbour_cells(faces);
  const std::vector<double> own = result.log_error;
  average(neighbours, result.log_error);
  for (std::size_t f = 0; f < own.size(); ++f) {
    result.log_error[f] = std::max(result.log_error[f], own[f] - std::log(kOutlier));
  }
  average(neighbours, result.bend);
  return result;
}

/// Share of the bending along an arm of length a, against the other of length b.
double share_of_bending(const Mat3& bend, const Vec3& a, const Vec3& b) {
  const double along = std::abs(a.dot(bend * a));
  const double across = std::abs(b.dot(bend * b));
  if (!(along + across > 0)) return 0.5;
  return std::clamp(along / (along + across), kLeastShare, 1 - kLeastShare);
}

}  // namespace

SizeResult size_from_errors(const TriMesh& mesh, const PrincipalField& field, const LineSet& lines,
                            const QuadMesh& quads, const DensityField* density,
                            const SizeOptions& options, Observer& observer) {
  observer.report("measuring distances", 0);
  const CellSampling sampling = density != nullptr ? CellSampling{} : kFewSamples;
  const ErrorMap errors = measure_cells(ComparedSurfaces(mesh, quads), sampling);
  const Averaged cells = averaged_errors(quads.mesh, errors, mesh.diagonal);
  const std::size_t wedges = mesh.wedge_vertex.size();
  std::vector<double> log_error(wedges);
  const std::vector<double> densities =
      density != nullptr ? density_at_wedges(mesh, *density) : std::vector<double>(wedges, 1);
  const std::vector<double> areas = wedge_areas(mesh);
  double sum = 0;
  double count = 0;
  for (std::size_t w = 0; w < wedges; ++w) {
    const Index cell = errors.vertex_cell[mesh.wedge_vertex[w]];
    log_error[w] = cells.log_error[cell] + std::log(densities[w]);
    const double vertices = areas[w] / (lines.spacing_along_min[w] * lines.spacing_along_max[w]);
    sum += vertices * log_error[w];
    count += vertices;
  }
  const double goal = options.tolerance
                          ? std::log(options.tolerance->resolve(mesh.diagonal) / mesh.diagonal)
                          : sum / count;

  const double feedback =
      options.feedback.value_or(density != nullptr ? kFeedbackOfDensity : kFeedback);

  SizeResult result;
  result.size.mesh_id = mesh.id;
  // Under a tolerance nothing is won where errors are small already.
  const double largest_growth = options.tolerance ? 1 : kLargestGrowth;
  const auto change = [&](double error, double share) {
    if (options.tolerance && error <= goal) return 1.0;
    const double factor = std::exp(feedback * (goal - error - std::log(2 * share)));
    return std::clamp(factor, kLargestShrink, largest_growth);
  };
  for (std::size_t w = 0; w < wedges; ++w) {
    const double along = lines.spacing_along_min[w];
    const double across = lines.spacing_along_max[w];
    const Vec3& arm = field.cross[w];
    const double share = share_of_bending(cells.bend[errors.vertex_cell[mesh.wedge_vertex[w]]],
                                          along * arm, across * field.normal[w].cross(arm));
    result.size.along.push_back(along * change(log_error[w], share));
    result.size.across.push_back(across * change(log_error[w], 1 - share));
  }
  result.report.set("size.rms", errors.rms);
  result.report.set("size.largest", errors.largest);
  result.report.set("size.goal", std::exp(goal) * mesh.diagonal);
  return result;
}

}  // namespace strake
