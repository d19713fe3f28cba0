#include "stages/restrict/stage.h"

#include "stages/restrict/restrict.h"

namespace strake {

Stage restrict_stage() {
  Stage stage;
  stage.name = "restrict";
  stage.summary = "Takes a field to a coarser mesh.";
  stage.inputs = {{.name = "mesh",
                   .kind = PortKind::mesh,
                   .help = "coarser mesh artifact, as strake-coarsen makes it"},
                  {.name = "field",
                   .kind = PortKind::field,
                   .help = "field artifact of the mesh it was made from",
                   .of_parent = true}};
  stage.output = {"coarse-field", PortKind::field, "field artifact to write: .hdf"};
  stage.run = [](Inputs& inputs, Observer& /*observer*/) {
    return StageResult{
        restrict_field(inputs.get<TriMesh>("mesh"), inputs.get<PrincipalField>("field")), {}};
  };
  return stage;
}

}  // namespace strake
