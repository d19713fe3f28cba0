#include "stages/fit/stage.h"

#include <utility>

#include "stages/fit/fit.h"

namespace strake {

Stage fit_stage() {
  Stage stage;
  stage.name = "fit";
  stage.version = 31;
  stage.summary = "Moves vertices of a result so that its faces lie nearer to the surface.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"quads", PortKind::quads, "quads artifact of that mesh"},
                  {"field", PortKind::field, "field artifact; edges are turned towards it", false}};
  stage.output = {"fitted", PortKind::quads, "result to write: .hdf, .obj, .ply or .off"};
  return with_options<FitOptions>(
      std::move(stage), [](const Inputs& inputs, const FitOptions& options, Observer& observer) {
        FitResult result =
            fit_vertices(inputs.get<TriMesh>("mesh"), inputs.find<PrincipalField>("field"),
                         inputs.get<QuadMesh>("quads"), options, observer);
        return StageResult{std::move(result.quads), std::move(result.report)};
      });
}

}  // namespace strake
