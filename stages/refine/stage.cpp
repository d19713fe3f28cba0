#include "stages/refine/stage.h"

#include <utility>

#include "stages/refine/refine.h"

namespace strake {

Stage refine_stage() {
  Stage stage;
  stage.name = "refine";
  stage.version = 30;
  stage.summary = "Divides cells of a result that are too far from the surface.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"fitted", PortKind::quads, "quads artifact of that mesh"}};
  stage.output = {"refined", PortKind::quads, "result to write: .hdf, .obj, .ply or .off"};
  return with_options<RefineOptions>(
      std::move(stage), [](const Inputs& inputs, const RefineOptions& options, Observer& observer) {
        RefineResult result = refine_cells(inputs.get<TriMesh>("mesh"),
                                           inputs.get<QuadMesh>("fitted"), options, observer);
        return StageResult{std::move(result.quads), std::move(result.report)};
      });
}

}  // namespace strake
