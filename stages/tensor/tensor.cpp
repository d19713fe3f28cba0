#include "stages/tensor/tensor.h"

#include <utility>

#include "stages/tensor/wedge_tensors.h"

namespace strake {

TensorResult estimate_tensors(const TriMesh& mesh, const TensorOptions& options,
                              Observer& observer) {
  const double radius = options.radius.resolve(mesh.diagonal);
  WedgeTensors tensors = estimate_wedge_tensors(mesh, mesh.wedge_count(), radius, observer);
  TensorResult result;
  result.field = {mesh.id, std::move(tensors.tensor), std::move(tensors.normal)};
  result.report.set("tensor.radius", radius);
  result.report.set("tensor.wedges", mesh.wedge_count());
  result.report.set("tensor.balls_grown_to_edge_length", tensors.grown);
  return result;
}

}  // namespace strake
