#include "stages/evaluate/stage.h"

#include <utility>

#include "stages/evaluate/evaluate.h"

namespace strake {

Stage evaluate_stage() {
  Stage stage;
  stage.name = "evaluate";
  stage.version = 14;
  stage.summary = "Measures a polygon mesh against the surface it approximates.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"candidate", PortKind::polygons, "quads artifact or mesh file to judge"},
                  {"field", PortKind::field, "field artifact, for the alignment figures", false}};
  stage.output = {"report", PortKind::report, "report to write, .json"};
  return with_options<EvaluateOptions>(
      std::move(stage),
      [](const Inputs& inputs, const EvaluateOptions& options, Observer& observer) {
        const auto& candidate = inputs.get<Polygons>("candidate");
        EvaluateResult result =
            evaluate_mesh(inputs.get<TriMesh>("mesh"), inputs.find<PrincipalField>("field"),
                          candidate.mesh, options, observer);
        candidate.read.add_to(result.report);
        return StageResult{std::nullopt, std::move(result.report)};
      });
}

}  // namespace strake
