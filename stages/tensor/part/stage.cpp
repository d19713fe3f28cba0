#include "stages/tensor/part/stage.h"

#include <utility>

#include "stages/tensor/stage.h"
#include "stages/tensor/tensor_part.h"

namespace strake {

Stage tensor_part_stage() {
  Stage stage;
  stage.name = "tensor-part";
  stage.version = tensor_stage().version;  // they share all code that makes a number
  stage.summary = "Estimates the curvature tensors of one part of a huge mesh.";
  stage.inputs = {{"mesh", PortKind::opened_mesh, "mesh artifact"}};
  stage.output = {"part", PortKind::tensor_part, "artifact of the part to write, .hdf"};
  return with_options<TensorPartOptions>(
      std::move(stage),
      [](const Inputs& inputs, const TensorPartOptions& options, Observer& observer) {
        const auto& mesh = inputs.get<OpenedMesh>("mesh");
        TensorPartResult result = estimate_tensor_part(*mesh, options, observer);
        return StageResult{std::move(result.part), std::move(result.report)};
      });
}

}  // namespace strake
