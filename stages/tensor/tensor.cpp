#include "stages/tensor/tensor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stages/tensor/wedge_tensors.h"

namespace strake {
namespace {

constexpr Length kDefaultRadius = percent(1);
constexpr double kMostFacesOfDefault = 2e6;

}  // namespace

double ball_radius(const TensorOptions& options, double diagonal, Index faces) {
  if (options.radius) return options.radius->resolve(diagonal);
  const double share = kMostFacesOfDefault / std::max<Index>(faces, 1);
  return std::sqrt(std::min(1.0, share)) * kDefaultRadius.resolve(diagonal);
}

TensorResult estimate_tensors(const TriMesh& mesh, const TensorOptions& options,
                              Observer& observer) {
  const double radius = ball_radius(options, mesh.diagonal, mesh.face_count());
  WedgeTensors tensors = estimate_wedge_tensors(mesh, mesh.wedge_count(), radius, observer);
  TensorResult result;
  result.field = {mesh.id, std::move(tensors.tensor), std::move(tensors.normal)};
  result.report.set("tensor.radius", radius);
  result.report.set("tensor.wedges", mesh.wedge_count());
  result.report.set("tensor.balls_grown_to_edge_length", tensors.grown);
  return result;
}

}  // namespace strake
