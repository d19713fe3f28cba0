#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/artifact/artifact.h"
#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "stages/evaluate/stage.h"
#include "stages/fit/stage.h"
#include "stages/import/stage.h"
#include "stages/mesh/stage.h"
#include "stages/smooth/stage.h"
#include "stages/tensor/stage.h"
#include "stages/trace/stage.h"
#include "strake/commands.h"
#include "strake/count_search.h"
#include "strake/pipeline.h"
#include "strake/summary.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

/// Error of a wanted count above which the user is told.
constexpr double kCountTolerance = 0.1;

/// Everything `strake remesh` was asked for.
struct RemeshCommand {
  std::string input;
  std::string output;
  std::string keep;
  std::string feature_edges;
  bool no_evaluate = false;
  ShellOptions shell;

  Stage import = import_stage();
  Stage tensor = tensor_stage();
  Stage smooth = smooth_stage();
  Stage trace = trace_stage();
  Stage mesh = mesh_stage();
  Stage fit = fit_stage();
  Stage evaluate = evaluate_stage();

  void add_to(CLI::App& app);
  void check() const;
  /// How one would say that the result was made in one go.
  [[nodiscard]] Provenance provenance(const std::string& input_digest) const;
  void run();

 private:
  void trace_and_mesh(Pipeline& pipeline) const;
  void meet_count(Pipeline& pipeline, const std::string& what, std::int64_t wanted,
                  ConsoleObserver& console) const;
};

void RemeshCommand::add_to(CLI::App& app) {
  app.add_option("input", input, "mesh file to remesh: OBJ, PLY, OFF or STL")
      ->type_name("FILE")
      ->required();
  app.add_option("-o,--output", output, "result to write: .obj, .ply, .off or .hdf")
      ->type_name("FILE")
      ->required();
  app.add_option("--keep", keep, "Keep the artifact and report of every stage in this folder.")
      ->type_name("FOLDER");
  app.add_option("--feature-edges", feature_edges, import.inputs.back().help)->type_name("FILE");
  app.add_flag("--no-evaluate", no_evaluate, "Do not measure the result.");
  for (const Stage* stage : {&import, &tensor, &smooth, &trace, &mesh, &fit, &evaluate}) {
    add_options(*app.add_option_group("Stage " + stage->name, stage->summary), stage->options);
  }
  shell.add_to(app);
}

void RemeshCommand::check() const {
  check_output_path(PortKind::quads, output);
  std::error_code ignored;
  if (fs::equivalent(input, output, ignored)) {
    throw UsageError("output '" + output + "' is the input; give another name");
  }
  int goals = 0;
  for (const char* name : {"tolerance", "vertices", "faces"}) {
    if (!trace.option(name).value().empty()) ++goals;
  }
  if (goals > 1) {
    throw UsageError("--tolerance, --vertices and --faces exclude each other; give one of them");
  }
}

Provenance RemeshCommand::provenance(const std::string& input_digest) const {
  Provenance whole;
  whole.stage = "remesh";
  for (const Stage* stage : {&import, &tensor, &smooth, &trace, &mesh, &fit}) {
    const Provenance part = provenance_of(*stage);
    whole.stage_version += part.stage_version;
    whole.options.insert(whole.options.end(), part.options.begin(), part.options.end());
  }
  whole.inputs = {{"input", input_digest}};
  return whole;
}

void RemeshCommand::trace_and_mesh(Pipeline& pipeline) const {
  pipeline.run(trace);
  pipeline.run(mesh);
}

void RemeshCommand::meet_count(Pipeline& pipeline, const std::string& what, std::int64_t wanted,
                               ConsoleObserver& console) const {
  const Option& option = trace.option("spacing-scale");
  CountSearch search(wanted, std::stod(option.value()), option.min, option.max);
  Pipeline best = pipeline;
  while (const std::optional<double> scale = search.next()) {
    option.parse_into(fmt::format("{}", *scale));
    try {
      trace_and_mesh(pipeline);
    } catch (const AlgorithmError& error) {
      if (search.trial_count() == 0) throw;
      console.say(std::string("warning: gave up correcting the count: ") + error.what());
      break;
    }
    const PolyMesh& result = pipeline.get<QuadMesh>("quads").mesh;
    const std::int64_t count = what == "vertices" ? result.vertex_count() : result.face_count();
    console.say(
        fmt::format("round {}: {} {}, {} wanted", search.trial_count() + 1, count, what, wanted));
    search.record(*scale, count);
    if (search.best().scale == *scale) best = pipeline;
  }
  pipeline = best;
  option.parse_into(fmt::format("{}", search.best().scale));
  if (search.error(search.best().count) > kCountTolerance) {
    console.say(
        fmt::format("warning: {} {} were wanted, but the nearest result has {}: the shape, "
                    "--max-spacing or the "
                    "mesh's own resolution do not allow it",
                    wanted, what, search.best().count));
  }
}

void RemeshCommand::run() {
  check();
  ConsoleObserver console = shell.console();
  console.begin("strake");
  console.report("reading " + input, 0);
  Pipeline pipeline(console);
  if (!keep.empty()) pipeline.keep_in(keep);
  const std::string digest = content_digest(input);
  pipeline.provide("input", load_value(PortKind::polygons, input), input, digest);
  if (!feature_edges.empty()) {
    pipeline.provide("feature-edges", load_value(PortKind::edge_list, feature_edges), feature_edges,
                     content_digest(feature_edges));
  }
  for (const Stage* stage : {&import, &tensor, &smooth}) {
    pipeline.run(*stage);
    pipeline.keep(*stage);
  }
  const std::string vertices = trace.option("vertices").value();
  const std::string faces = trace.option("faces").value();
  if (!vertices.empty()) {
    meet_count(pipeline, "vertices", std::stoll(vertices), console);
  } else if (!faces.empty()) {
    meet_count(pipeline, "faces", std::stoll(faces), console);
  } else {
    trace_and_mesh(pipeline);
  }
  pipeline.keep(trace);
  pipeline.keep(mesh);
  pipeline.run(fit);
  pipeline.keep(fit);
  const QuadMesh& quads = pipeline.get<QuadMesh>("fitted");
  if (!no_evaluate) {
    pipeline.provide_as("candidate", Polygons{quads.mesh, quads.mesh_id, {}}, "fitted");
    pipeline.run(evaluate);
    pipeline.keep(evaluate);
  }
  save_value(output, quads, nullptr, provenance(digest));
  if (!shell.report_path.empty()) write_text(shell.report_path, records_json(pipeline.records()));
  if (shell.verbose) {
    for (const StageRecord& record : pipeline.records()) {
      console.say("\n" + record.provenance.stage + "\n" + report_text(record.report));
    }
  }
  const Report* measures = no_evaluate ? nullptr : &pipeline.records().back().report;
  if (!shell.quiet) std::fputs(summary_text(output, quads.mesh, measures).c_str(), stdout);
}

}  // namespace

void add_remesh_command(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("remesh", "Remesh a surface with quads along its curvature.");
  const auto remesh = std::make_shared<RemeshCommand>();
  remesh->add_to(*command);
  command->callback([remesh, &chosen] {
    chosen = [remesh] {
      run_with_threads(remesh->shell.threads, [&] { remesh->run(); });
      return 0;
    };
  });
}

}  // namespace strake
