#include "stages/tensor/stage.h"

#include <utility>

#include "stages/tensor/tensor.h"

namespace strake {

Stage tensor_stage() {
  Stage stage;
  stage.name = "tensor";
  stage.version = 6;
  stage.summary = "Estimates the curvature tensor of a mesh at every vertex.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"}};
  stage.output = {"tensor", PortKind::tensor, "tensor artifact to write, .hdf"};
  return with_options<TensorOptions>(
      std::move(stage), [](const Inputs& inputs, const TensorOptions& options, Observer& observer) {
        TensorResult result = estimate_tensors(inputs.get<TriMesh>("mesh"), options, observer);
        return StageResult{std::move(result.field), std::move(result.report)};
      });
}

}  // namespace strake
