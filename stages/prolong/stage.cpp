#include "stages/prolong/stage.h"

#include "stages/prolong/prolong.h"

namespace strake {

Stage prolong_stage() {
  Stage stage;
  stage.name = "prolong";
  stage.summary = "Takes a field from a coarser mesh back to the one it was made from.";
  stage.inputs = {
      {.name = "mesh", .kind = PortKind::mesh, .help = "mesh artifact", .of_parent = true},
      {.name = "coarse",
       .kind = PortKind::mesh,
       .help = "coarser mesh artifact, as strake-coarsen makes it"},
      {.name = "coarse-field",
       .kind = PortKind::field,
       .help = "field artifact of the coarser mesh"}};
  stage.output = {"field", PortKind::field, "field artifact to write: .hdf"};
  stage.run = [](Inputs& inputs, Observer& /*observer*/) {
    return StageResult{prolong_field(inputs.get<TriMesh>("mesh"), inputs.get<TriMesh>("coarse"),
                                     inputs.get<PrincipalField>("coarse-field")),
                       {}};
  };
  return stage;
}

}  // namespace strake
