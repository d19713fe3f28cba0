#include "stages/refine/worst/stage.h"

#include <utility>

#include "stages/refine/worst.h"

namespace strake {

Stage refine_worst_stage() {
  Stage stage;
  stage.name = "refine-worst";
  stage.version = 4;
  stage.summary = "Brings the places of a result that are farthest off nearer to the surface.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"fitted", PortKind::quads, "quads artifact of that mesh"}};
  stage.output = {"improved", PortKind::quads, "result to write: .hdf, .obj, .ply or .off"};
  return with_options<WorstOptions>(
      std::move(stage), [](const Inputs& inputs, const WorstOptions& options, Observer& observer) {
        WorstResult result = bring_worst_nearer(inputs.get<TriMesh>("mesh"),
                                                inputs.get<QuadMesh>("fitted"), options, observer);
        return StageResult{std::move(result.quads), std::move(result.report)};
      });
}

}  // namespace strake
