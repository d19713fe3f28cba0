#include "stages/tensor/tensor.h"

#include <utility>

#include "stages/tensor/wedge_tensors.h"

namespace strake {

TensorResult estimate_tensors(const TriMesh& mesh, const TensorOptions& options,
                              Observer& observer) {
  const BallRule rule = ball_rule(options, mesh.diagonal, mesh.face_count());
  WedgeTensors tensors = estimate_wedge_tensors(mesh, mesh.wedge_count(), rule, observer);
  TensorResult result;
  result.field = {mesh.id, std::move(tensors.tensor), std::move(tensors.normal)};
  result.report.set("tensor.radius", rule.radius);
  result.report.set("tensor.wedges", mesh.wedge_count());
  result.report.set("tensor.balls_grown_to_edge_length", tensors.grown);
  result.report.set("tensor.balls_shrunk_to_fewer_faces", tensors.shrunk);
  return result;
}

}  // namespace strake
