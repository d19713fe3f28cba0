#include "stages/import/stage.h"

#include <utility>

#include "common/core/error.h"
#include "common/core/text.h"
#include "stages/import/import.h"

namespace strake {
namespace {

/// As import_mesh, with the name of the file in what is wrong with it.
ImportResult import_file(const Inputs& inputs, const ImportOptions& options, Observer& observer) {
  try {
    return import_mesh(inputs.get<Polygons>("input").mesh, options, observer,
                       inputs.find<EdgeList>("feature-edges"));
  } catch (const InputError& error) {
    throw InputError(inputs.at("input").origin + ": " + error.what());
  }
}

}  // namespace

Stage import_stage() {
  Stage stage;
  stage.name = "import";
  stage.version = 24;
  stage.summary = "Turns a mesh file into a sound triangle mesh with its feature graph.";
  stage.inputs = {
      {"input", PortKind::polygons, "mesh file: OBJ, PLY, OFF or STL"},
      {"feature-edges", PortKind::edge_list,
       "text file of further feature edges: vertex numbers, from 0, along each", false}};
  stage.output = {"mesh", PortKind::mesh, "mesh artifact to write, .hdf"};
  return with_options<ImportOptions>(
      std::move(stage), [](const Inputs& inputs, const ImportOptions& options, Observer& observer) {
        const auto& input = inputs.get<Polygons>("input");
        const std::vector<std::string> defects = input.read.warnings();
        if (options.strict && !defects.empty()) {
          throw InputError(inputs.at("input").origin + ": " + join_words(defects) +
                           "; leave --strict out to go on without");
        }
        ImportResult result = import_file(inputs, options, observer);
        input.read.add_to(result.report);
        return StageResult{std::move(result.mesh), std::move(result.report)};
      });
}

}  // namespace strake
