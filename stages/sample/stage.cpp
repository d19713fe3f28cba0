#include "stages/sample/stage.h"

#include <utility>

#include "stages/sample/sample.h"

namespace strake {

Stage sample_stage() {
  Stage stage;
  stage.name = "sample";
  stage.version = 1;
  stage.summary = "Makes a surface to try things on.";
  stage.output = {"sample", PortKind::polygons, "mesh file to write: .obj, .ply or .off"};
  return with_options<SampleStageOptions>(
      std::move(stage),
      [](const Inputs& /*inputs*/, const SampleStageOptions& options, Observer& /*observer*/) {
        Polygons polygons;
        polygons.mesh = sample_surface(options);
        return StageResult{std::move(polygons), {}};
      });
}

}  // namespace strake
