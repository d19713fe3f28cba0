#include "stages/coarsen/stage.h"

#include <utility>

#include "stages/coarsen/coarsen.h"

namespace strake {

Stage coarsen_stage() {
  Stage stage;
  stage.name = "coarsen";
  stage.summary = "Makes a coarser mesh to work on, where the input is much finer than the result.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"}};
  stage.output = {"coarse", PortKind::mesh, "mesh artifact to write: .hdf"};
  return with_options<CoarsenOptions>(
      std::move(stage),
      [](const Inputs& inputs, const CoarsenOptions& options, Observer& observer) {
        CoarsenResult result = coarsen_mesh(inputs.get<TriMesh>("mesh"), options, observer);
        return StageResult{std::move(result.mesh), std::move(result.report)};
      });
}

}  // namespace strake
