#include "stages/tensor/tensor_part.h"

#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "stages/tensor/part_mesh.h"
#include "stages/tensor/wedge_tensors.h"

namespace strake {

TensorPartResult estimate_tensor_part(const MeshBlocks& blocks, const TensorPartOptions& options,
                                      Observer& observer) {
  if (options.part > options.parts) {
    throw UsageError("--part " + std::to_string(options.part) + ": there are only " +
                     std::to_string(options.parts) + " parts (--parts)");
  }
  const BallRule rule = ball_rule(options.tensor, blocks.header().diagonal, blocks.header().faces);
  const auto parts = static_cast<Index>(options.parts);
  const auto number = static_cast<Index>(options.part);
  PartMesh part = read_part(blocks, parts, number - 1, kLargestGrowth * rule.radius, observer);
  const auto count = static_cast<Index>(part.wedge.size());
  std::vector<Index> own(part.wedge.size());  // come first
  std::iota(own.begin(), own.end(), Index{0});
  WedgeTensors tensors = estimate_wedge_tensors(part.mesh, own, rule, observer);

  TensorPartResult result;
  result.part.mesh_id = blocks.header().id;
  result.part.part = number;
  result.part.parts = parts;
  result.part.wedge = std::move(part.wedge);
  for (Index w = 0; w < count; ++w) {
    result.part.position.push_back(part.mesh.positions[part.mesh.wedge_vertex[w]]);
  }
  result.part.tensor = std::move(tensors.tensor);
  result.part.normal = std::move(tensors.normal);
  result.report.set("tensor.radius", rule.radius);
  result.report.set("tensor.wedges", count);
  result.report.set("tensor.faces_kept", part.mesh.face_count());
  result.report.set("tensor.faces", blocks.header().faces);
  result.report.set("tensor.balls_grown_to_edge_length", tensors.grown);
  result.report.set("tensor.balls_shrunk_to_fewer_faces", tensors.shrunk);
  return result;
}

}  // namespace strake
