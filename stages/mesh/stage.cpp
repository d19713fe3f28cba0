#include "stages/mesh/stage.h"

#include <utility>

#include "stages/mesh/mesh.h"

namespace strake {

Stage mesh_stage() {
  Stage stage;
  stage.name = "mesh";
  stage.version = 15;
  stage.summary = "Builds the quad-dominant mesh whose edges run along the lines.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"lines", PortKind::lines, "lines artifact of that mesh"}};
  stage.output = {"quads", PortKind::quads,
                  "result to write: .hdf (with provenance), .obj, .ply or .off"};
  return with_options<MeshOptions>(
      std::move(stage), [](const Inputs& inputs, const MeshOptions& options, Observer& observer) {
        MeshResult result = mesh_lines(inputs.get<TriMesh>("mesh"), inputs.get<LineSet>("lines"),
                                       options, observer);
        return StageResult{std::move(result.quads), std::move(result.report)};
      });
}

}  // namespace strake
