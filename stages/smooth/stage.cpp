#include "stages/smooth/stage.h"

#include <utility>

#include "stages/smooth/smooth.h"

namespace strake {

Stage smooth_stage() {
  Stage stage;
  stage.name = "smooth";
  stage.version = 11;
  stage.summary = "Smooths curvature tensors and extracts principal frames.";
  stage.inputs = {
      {"mesh", PortKind::mesh, "mesh artifact"},
      {"tensor", PortKind::tensor, "tensor artifact of that mesh"},
      {"guides", PortKind::guides,
       "OBJ file of lines, or PLY of edges, near the surface, for edges to run along", false}};
  stage.output = {"field", PortKind::field, "field artifact to write, .hdf"};
  return with_options<SmoothOptions>(
      std::move(stage), [](Inputs& inputs, const SmoothOptions& options, Observer& observer) {
        SmoothResult result =
            smooth_tensors(inputs.get<TriMesh>("mesh"), inputs.take<TensorField>("tensor"), options,
                           observer, inputs.find<GuideLines>("guides"));
        return StageResult{std::move(result.field), std::move(result.report)};
      });
}

}  // namespace strake
