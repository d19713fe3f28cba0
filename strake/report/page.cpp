#include "strake/report/page.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/core/error.h"
#include "common/geometry/cell_error/cell_error.h"
#include "strake/report/blocks.h"
#include "strake/report/histograms.h"
#include "strake/report/scene.h"

namespace strake::report {
namespace {

using Json = nlohmann::ordered_json;

/// Version of what the viewer reads.
constexpr int kReportFormat = 2;
constexpr std::string_view kJsonMark = "%STRAKE_REPORT%";
constexpr std::string_view kBlocksMark = "%STRAKE_BLOCKS%";

Json describe_run(const RunFiles& run, std::size_t surface, Blocks& blocks) {
  const PrincipalField* field = run.field ? &*run.field : nullptr;
  const ErrorMap errors = measure_cells(ComparedSurfaces(run.mesh, run.quads));
  const ResultEdges result = measure_edges(run.mesh, field, run.quads);
  Json json = {{"name", run.name},
               {"surface", surface},
               {"result", result_scene(run.quads.provenance, result, errors, blocks)},
               {"histograms", to_json(measure_histograms(result, errors, run.mesh.diagonal))},
               {"stages", run.stages},
               {"seconds", run.seconds},
               {"missing", run.missing}};
  if (run.lines) json["lines"] = line_scene(run.line_mesh(), *run.lines, kMostLinePoints, blocks);
  return json;
}

std::string put(std::string page, std::string_view mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos || page.find(mark, at + 1) != std::string::npos) {
    throw PreconditionError("the viewer's page does not hold " + std::string(mark) +
                            " once; build it again with scripts/build_viewer");
  }
  return page.replace(at, mark.size(), text);
}

}  // namespace

std::string script_safe(std::string json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

PageData describe_runs(const std::vector<RunFiles>& runs) {
  Blocks blocks;
  Json surfaces = Json::array();
  Json described = Json::array();
  std::vector<std::string> known;  // contents of mesh and field
  for (const RunFiles& run : runs) {
    const std::string wanted = run.mesh.id + " " + run.field_content;
    const auto place = std::find(known.begin(), known.end(), wanted);
    const auto surface = static_cast<std::size_t>(place - known.begin());
    if (place == known.end()) {
      known.push_back(wanted);
      surfaces.push_back(
          surface_scene(run.mesh, run.field ? &*run.field : nullptr, kMostFaces, blocks));
    }
    described.push_back(describe_run(run, surface, blocks));
  }
  const Json report = {{"format", kReportFormat},
                       {"program", "strake " STRAKE_VERSION},
                       {"surfaces", std::move(surfaces)},
                       {"runs", std::move(described)}};
  constexpr bool kAsciiOnly = true;
  return {script_safe(report.dump(-1, ' ', kAsciiOnly, Json::error_handler_t::replace)),
          blocks.packed()};
}

std::string fill_page(std::string_view viewer, const PageData& data) {
  // In this order a mark in a run's name is no mark: base64 has no %.
  std::string page = put(std::string(viewer), kBlocksMark, data.blocks);
  return put(std::move(page), kJsonMark, data.json);
}

}  // namespace strake::report
