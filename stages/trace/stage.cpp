#include "stages/trace/stage.h"

#include <utility>

#include "stages/trace/trace.h"

namespace strake {

Stage trace_stage() {
  Stage stage;
  stage.name = "trace";
  stage.version = 20;
  stage.summary = "Covers a mesh with lines of curvature, boundary and feature lines.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"field", PortKind::field, "field artifact of that mesh"},
                  {"size", PortKind::size, "distances between lines to take instead", false},
                  {"density", PortKind::density,
                   "PLY file, that of the mesh, with a vertex property 'density'", false}};
  stage.output = {"lines", PortKind::lines, "lines artifact to write, .hdf"};
  return with_options<TraceOptions>(
      std::move(stage), [](const Inputs& inputs, const TraceOptions& options, Observer& observer) {
        TraceResult result = trace_lines(
            inputs.get<TriMesh>("mesh"), inputs.get<PrincipalField>("field"), options, observer,
            {inputs.find<SizeField>("size"), inputs.find<DensityField>("density")});
        return StageResult{std::move(result.lines), std::move(result.report)};
      });
}

}  // namespace strake
