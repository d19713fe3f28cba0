#include "stages/lift/stage.h"

#include "stages/lift/lift.h"

namespace strake {

Stage lift_stage() {
  Stage stage;
  stage.name = "lift";
  stage.version = 3;
  stage.summary = "Takes a result from a coarser mesh back to the one it was made from.";
  stage.inputs = {
      {.name = "mesh", .kind = PortKind::mesh, .help = "mesh artifact", .of_parent = true},
      {.name = "coarse",
       .kind = PortKind::mesh,
       .help = "coarser mesh artifact, as strake-coarsen makes it"},
      {.name = "coarse-quads",
       .kind = PortKind::quads,
       .help = "quads artifact of the coarser mesh"}};
  stage.output = {"lifted", PortKind::quads, "result to write: .hdf, .obj, .ply or .off"};
  stage.run = [](Inputs& inputs, Observer& /*observer*/) {
    return StageResult{lift_quads(inputs.get<TriMesh>("mesh"), inputs.get<TriMesh>("coarse"),
                                  inputs.get<QuadMesh>("coarse-quads")),
                       {}};
  };
  return stage;
}

}  // namespace strake
