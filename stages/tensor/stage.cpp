#include "stages/tensor/stage.h"

#include <utility>

#include "stages/tensor/tensor.h"

namespace strake {

Stage tensor_stage() {
  Stage stage;
  stage.name = "tensor";
  stage.version = 8;
  stage.summary = "Estimates the curvature tensor of a mesh at every vertex.";
  stage.inputs = {
      {.name = "mesh", .kind = PortKind::mesh, .help = "mesh artifact", .of_parent = true},
      {.name = "coarse",
       .kind = PortKind::mesh,
       .help = "coarser mesh artifact, as strake-coarsen makes it: tensors at its vertices alone",
       .required = false}};
  stage.output = {"tensor", PortKind::tensor, "tensor artifact to write, .hdf"};
  return with_options<TensorOptions>(
      std::move(stage), [](const Inputs& inputs, const TensorOptions& options, Observer& observer) {
        TensorResult result = estimate_tensors(inputs.get<TriMesh>("mesh"), options, observer,
                                               inputs.find<TriMesh>("coarse"));
        return StageResult{std::move(result.field), std::move(result.report)};
      });
}

}  // namespace strake
