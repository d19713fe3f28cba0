#include "stages/export/stage.h"

#include <utility>

namespace strake {
namespace {

struct NoOptions {
  static OptionList declare() { return {}; }
};

}  // namespace

Stage export_stage() {
  Stage stage;
  stage.name = "export";
  stage.version = 2;
  stage.summary = "Writes the mesh of a quads artifact as a mesh file.";
  stage.inputs = {{"quads", PortKind::quads, "quads artifact"}};
  stage.output = {"quads", PortKind::polygons, "mesh file to write: .obj, .ply or .off"};
  return with_options<NoOptions>(
      std::move(stage),
      [](const Inputs& inputs, const NoOptions& /*options*/, Observer& /*observer*/) {
        const auto& quads = inputs.get<QuadMesh>("quads");
        return StageResult{Polygons{quads.mesh, quads.mesh_id, {}}, {}};
      });
}

}  // namespace strake
