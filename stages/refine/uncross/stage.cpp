#include "stages/refine/uncross/stage.h"

#include <utility>

#include "stages/refine/uncross.h"

namespace strake {

Stage refine_uncross_stage() {
  Stage stage;
  stage.name = "refine-uncross";
  stage.version = 10;
  stage.summary = "Takes the input's own faces where faces of a result cross.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"fitted", PortKind::quads, "quads artifact of that mesh"}};
  stage.output = {"uncrossed", PortKind::quads, "result to write: .hdf, .obj, .ply or .off"};
  stage.run = [](const Inputs& inputs, Observer& observer) {
    UncrossResult result =
        uncross_faces(inputs.get<TriMesh>("mesh"), inputs.get<QuadMesh>("fitted"), observer);
    return StageResult{std::move(result.quads), std::move(result.report)};
  };
  return stage;
}

}  // namespace strake
