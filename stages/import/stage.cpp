#include "stages/import/stage.h"

#include <utility>

#include "common/core/error.h"
#include "stages/import/import.h"

namespace strake {

Stage import_stage() {
  Stage stage;
  stage.name = "import";
  stage.version = 2;
  stage.summary = "Turns a mesh file into a sound triangle mesh with its feature graph.";
  stage.inputs = {{"input", PortKind::polygons, "mesh file: OBJ, PLY, OFF or STL"}};
  stage.output = {"mesh", PortKind::mesh, "mesh artifact to write, .hdf"};
  return with_options<ImportOptions>(
      std::move(stage), [](const Inputs& inputs, const ImportOptions& options, Observer& observer) {
        const auto& input = inputs.get<Polygons>("input");
        const std::vector<std::string> defects = input.read.warnings();
        if (options.strict && !defects.empty()) {
          throw InputError(inputs.at("input").origin + ": " + defects.front() +
                           " Leave --strict out to go on without.");
        }
        ImportResult result = import_mesh(input.mesh, options, observer);
        input.read.add_to(result.report);
        return StageResult{std::move(result.mesh), std::move(result.report)};
      });
}

}  // namespace strake
