#include "stages/decimate/stage.h"

#include <utility>

#include "stages/decimate/decimate.h"

namespace strake {

Stage decimate_stage() {
  Stage stage;
  stage.name = "decimate";
  stage.version = 6;
  stage.summary = "Makes a mesh by decimation, for counts too small for lines.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"}};
  stage.output = {"decimated", PortKind::quads, "result to write: .hdf, .obj, .ply or .off"};
  return with_options<DecimateOptions>(
      std::move(stage),
      [](const Inputs& inputs, const DecimateOptions& options, Observer& observer) {
        DecimateResult result = decimate_to_quads(inputs.get<TriMesh>("mesh"), options, observer);
        return StageResult{std::move(result.quads), std::move(result.report)};
      });
}

}  // namespace strake
