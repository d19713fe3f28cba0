#include "stages/tensor/tensor.h"

#include <numeric>
#include <utility>
#include <vector>

#include "stages/tensor/wedge_tensors.h"

namespace strake {

TensorResult estimate_tensors(const TriMesh& mesh, const TensorOptions& options, Observer& observer,
                              const TriMesh* coarse) {
  const BallRule rule = ball_rule(options, mesh.diagonal, mesh.face_count());
  std::vector<Index> all;
  if (coarse == nullptr) {
    all.resize(static_cast<std::size_t>(mesh.wedge_count()));
    std::iota(all.begin(), all.end(), Index{0});
  }
  const std::vector<Index>& wedges = coarse == nullptr ? all : coarse->parent_wedge;
  WedgeTensors tensors = estimate_wedge_tensors(mesh, wedges, rule, observer);
  TensorResult result;
  result.field = {coarse == nullptr ? mesh.id : coarse->id, std::move(tensors.tensor),
                  std::move(tensors.normal)};
  result.report.set("tensor.radius", rule.radius);
  result.report.set("tensor.wedges", static_cast<std::int64_t>(wedges.size()));
  result.report.set("tensor.balls_grown_to_edge_length", tensors.grown);
  result.report.set("tensor.balls_shrunk_to_fewer_faces", tensors.shrunk);
  return result;
}

}  // namespace strake
