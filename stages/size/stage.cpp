#include "stages/size/stage.h"

#include <utility>

#include "stages/size/size.h"

namespace strake {

Stage size_stage() {
  Stage stage;
  stage.name = "size";
  stage.version = 8;
  stage.summary = "Wants lines closer where a result is too far from the surface.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"field", PortKind::field, "field artifact of that mesh"},
                  {"lines", PortKind::lines, "lines artifact that the result was made from"},
                  {"fitted", PortKind::quads, "the result, a quads artifact"},
                  {"density", PortKind::density,
                   "PLY file, that of the mesh, with a vertex property 'density'", false}};
  stage.output = {"size", PortKind::size, "size artifact to write, .hdf"};
  return with_options<SizeOptions>(
      std::move(stage), [](const Inputs& inputs, const SizeOptions& options, Observer& observer) {
        SizeResult result =
            size_from_errors(inputs.get<TriMesh>("mesh"), inputs.get<PrincipalField>("field"),
                             inputs.get<LineSet>("lines"), inputs.get<QuadMesh>("fitted"),
                             inputs.find<DensityField>("density"), options, observer);
        return StageResult{std::move(result.size), std::move(result.report)};
      });
}

}  // namespace strake
