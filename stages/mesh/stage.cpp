#include "stages/mesh/stage.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "common/core/number_text.h"
#include "common/core/wanted_count.h"
#include "stages/mesh/mesh.h"

namespace strake {
namespace {

/// The count that lines were traced for, as their file says; what says no count is none.
std::optional<std::int64_t> wanted_of_lines(const Input& lines, Counted counted) {
  if (!lines.provenance) return std::nullopt;
  for (const auto& option : lines.provenance->options) {
    if (option.name != name_of(counted)) continue;
    const std::optional<std::int64_t> wanted = parse_whole_number(option.value);
    if (wanted && *wanted > 0) return wanted;
  }
  return std::nullopt;
}

/// What to trace with instead: cells are as many as the square of distances is small.
std::string other_distances(std::int64_t wanted, std::int64_t reached) {
  const double hundredths =
      std::round(100 * std::sqrt(static_cast<double>(reached) / static_cast<double>(wanted)));
  const auto factor = static_cast<std::int64_t>(std::max(hundredths, 1.0));
  const std::string decimals = std::to_string(factor % 100);
  return "lines are counted before there are faces; try --spacing-scale of trace at " +
         std::to_string(factor / 100) + (decimals.size() == 1 ? ".0" : ".") + decimals +
         " times the trace.spacing_scale of its report, or 'strake remesh', which looks at faces";
}

/// Tells the user where lines were traced for a count that their faces miss. In a chain in memory,
/// whose lines come without a file, the chain sees to counts.
void warn_of_missed_count(const Inputs& inputs, const PolyMesh& made, Report& report) {
  const auto& is_corner = inputs.get<TriMesh>("mesh").is_corner;
  const auto corners = static_cast<std::int64_t>(std::count(is_corner.begin(), is_corner.end(), 1));
  for (const Counted counted : {Counted::vertices, Counted::faces}) {
    const auto wanted = wanted_of_lines(inputs.at("lines"), counted);
    if (!wanted) continue;
    const std::int64_t reached =
        counted == Counted::vertices ? made.vertex_count() : made.face_count();
    const std::string missed =
        missed_count({counted, *wanted, reached, corners}, "the mesh of these lines has",
                     other_distances(*wanted, reached));
    if (!missed.empty()) report.warn(missed);
  }
}

}  // namespace

Stage mesh_stage() {
  Stage stage;
  stage.name = "mesh";
  stage.version = 26;
  stage.summary = "Builds the quad-dominant mesh whose edges run along the lines.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {"lines", PortKind::lines, "lines artifact of that mesh"}};
  stage.output = {"quads", PortKind::quads,
                  "result to write: .hdf (with provenance), .obj, .ply or .off"};
  return with_options<MeshOptions>(
      std::move(stage), [](const Inputs& inputs, const MeshOptions& options, Observer& observer) {
        MeshResult result = mesh_lines(inputs.get<TriMesh>("mesh"), inputs.get<LineSet>("lines"),
                                       options, observer);
        warn_of_missed_count(inputs, result.quads.mesh, result.report);
        return StageResult{std::move(result.quads), std::move(result.report)};
      });
}

}  // namespace strake
