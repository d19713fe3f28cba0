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
#include "stages/refine/stage.h"
#include "stages/size/stage.h"
#include "stages/smooth/stage.h"
#include "stages/tensor/stage.h"
#include "stages/trace/stage.h"
#include "strake/commands.h"
#include "strake/goals.h"
#include "strake/session.h"
#include "strake/summary.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

/// A file beside the mesh, that a stage takes by the port of its name.
struct SideFile {
  std::string port;
  PortKind kind = PortKind::report;
  std::string path = {};  ///< "": not given
};

/// Everything `strake remesh` was asked for.
struct RemeshCommand {
  std::string input;
  std::string output;
  std::string keep;
  SideFile feature_edges = {"feature-edges", PortKind::edge_list};
  SideFile guides = {"guides", PortKind::guides};
  SideFile density = {"density", PortKind::density};
  std::optional<std::int64_t> feedback_rounds;
  OptionList own_options = {
      {.name = "feedback-rounds",
       .target = &feedback_rounds,
       .unit = "",
       .help = "Times that lines are traced again to even out errors, where a count is wanted; 1, "
               "with a density as many as it takes.",
       .min = 0,
       .max = 20}};
  bool no_evaluate = false;
  ShellOptions shell;

  Stage import = import_stage();
  Stage tensor = tensor_stage();
  Stage smooth = smooth_stage();
  Stage trace = trace_stage();
  Stage mesh = mesh_stage();
  Stage fit = fit_stage();
  Stage size = size_stage();
  Stage refine = refine_stage();
  Stage evaluate = evaluate_stage();

  void add_to(CLI::App& app);
  void check() const;
  [[nodiscard]] std::vector<SideFile> side_files() const;
  /// How one would say that the result was made in one go.
  [[nodiscard]] Provenance provenance(const std::string& input_digest) const;
  void run();

 private:
  /// Runs the stages from tracing on, as often as the goal takes. \return the port of the result
  std::string reach_goal(Session& session, ConsoleObserver& console) const;
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
  app.add_option("--feature-edges", feature_edges.path, import.inputs.back().help)
      ->type_name("FILE");
  app.add_option("--guides", guides.path, smooth.inputs.back().help)->type_name("FILE");
  app.add_option("--density", density.path,
                 "PLY file of the same vertices, with a vertex property 'density': wanted vertices "
                 "per area, relative to what they would be.")
      ->type_name("FILE.ply");
  add_options(app, own_options);
  app.add_flag("--no-evaluate", no_evaluate, "Do not measure the result.");
  for (const Stage* stage :
       {&import, &tensor, &smooth, &trace, &mesh, &fit, &size, &refine, &evaluate}) {
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

std::vector<SideFile> RemeshCommand::side_files() const {
  std::vector<SideFile> given;
  for (const SideFile* file : {&feature_edges, &guides, &density}) {
    if (!file->path.empty()) given.push_back(*file);
  }
  return given;
}

Provenance RemeshCommand::provenance(const std::string& input_digest) const {
  Provenance whole;
  whole.stage = "remesh";
  for (const Stage* stage : {&import, &tensor, &smooth, &trace, &mesh, &fit, &size, &refine}) {
    const Provenance part = provenance_of(*stage);
    whole.stage_version += part.stage_version;
    whole.options.insert(whole.options.end(), part.options.begin(), part.options.end());
  }
  const Option& rounds = own_options.front();
  whole.options.push_back({rounds.name, rounds.value(), !feedback_rounds});
  whole.inputs = {{"input", input_digest}};
  for (const SideFile& file : side_files()) {
    whole.inputs.push_back({file.port, content_digest(file.path)});
  }
  return whole;
}

std::string RemeshCommand::reach_goal(Session& session, ConsoleObserver& console) const {
  const GoalStages stages{trace, mesh, fit, size, refine};
  for (const Counted counted : {Counted::vertices, Counted::faces}) {
    const char* name = counted == Counted::vertices ? "vertices" : "faces";
    const std::string wanted = trace.option(name).value();
    if (wanted.empty()) continue;
    return meet_count(session, stages, counted, std::stoll(wanted), feedback_rounds, console);
  }
  const std::string tolerance = trace.option("tolerance").value();
  if (tolerance.empty()) return follow_spacing(session, stages);
  return meet_tolerance(session, stages, tolerance, console);
}

void RemeshCommand::run() {
  check();
  ConsoleObserver console = shell.console();
  console.begin("strake");
  console.report("reading " + input, 0);
  Session session(console);
  if (!keep.empty()) session.keep_in(keep);
  const std::string digest = content_digest(input);
  session.provide("input", load_value(PortKind::polygons, input), input, digest);
  for (const SideFile& file : side_files()) {
    session.provide(file.port, load_value(file.kind, file.path), file.path,
                    content_digest(file.path));
  }
  for (const Stage* stage : {&import, &tensor, &smooth}) {
    session.run(*stage);
    session.keep(*stage);
  }
  const std::string port = reach_goal(session, console);
  const QuadMesh& quads = session.get<QuadMesh>(port);
  if (!no_evaluate) {
    session.provide_as("candidate", Polygons{quads.mesh, quads.mesh_id, {}}, port);
    session.run(evaluate);
    session.keep(evaluate);
  }
  save_value(output, quads, nullptr, provenance(digest));
  if (!shell.report_path.empty()) write_text(shell.report_path, records_json(session.records()));
  if (shell.verbose) {
    for (const StageRecord& record : session.records()) {
      console.say("\n" + record.provenance.stage + "\n" + report_text(record.report));
    }
  }
  const Report* measures = no_evaluate ? nullptr : &session.records().back().report;
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
