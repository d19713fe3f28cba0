#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/artifact/artifact.h"
#include "common/artifact/meshfile/material_files.h"
#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "common/stage/repro.h"
#include "strake/chain/chain.h"
#include "strake/commands.h"
#include "strake/kept_folder.h"
#include "strake/summary.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples =
    R"(Examples:
  strake remesh scan.ply -o quads.obj
  strake remesh scan.ply -o quads.obj --vertices 5000 --radius 2%
  strake remesh part.stl -o part.obj --tolerance 0.1%
  strake remesh part.stl -o part.obj --pure-quads --feature-angle 30 --keep work)";

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
  bool no_evaluate = false;
  ShellOptions shell;

  Chain chain;
  Provenance asked;  ///< with the inputs that have been read

  void add_to(CLI::App& app);
  void check() const;
  [[nodiscard]] std::vector<SideFile> side_files() const;
  /// How one would say that the result was made in one go, but for its inputs. The chain changes
  /// options on its way.
  [[nodiscard]] Provenance without_inputs();
  /// Reads a file for a port, and notes what it holds: it may be another one before the run ends.
  void provide(Session& session, const std::string& port, PortKind kind, const std::string& path);
  void run();
  void make_output();
};

/// Writes the result, naming the files of its materials as they are seen from there.
void save_result(const fs::path& output, const QuadMesh& quads, const fs::path& input,
                 const Provenance& provenance) {
  if (quads.mesh.attributes.material_files.empty()) {
    save_value(output, quads, nullptr, provenance);
    return;
  }
  QuadMesh moved = quads;
  std::vector<std::string>& files = moved.mesh.attributes.material_files;
  files = material_files_seen_from(files, input, output);
  save_value(output, moved, nullptr, provenance);
}

void RemeshCommand::add_to(CLI::App& app) {
  app.add_option("input", input, "mesh file to remesh: OBJ, PLY, OFF or STL")
      ->type_name("FILE")
      ->required();
  app.add_option("-o,--output", output, "result to write: .obj, .ply, .off or .hdf")
      ->type_name("FILE")
      ->required();
  app.add_option(
         "--keep", keep,
         "Keep the artifact and report of every stage in this folder, in place of those of an "
         "earlier run.")
      ->type_name("FOLDER");
  app.add_option("--feature-edges", feature_edges.path, chain.import.inputs.back().help)
      ->type_name("FILE");
  app.add_option("--guides", guides.path, chain.smooth.inputs.back().help)->type_name("FILE");
  app.add_option("--density", density.path,
                 "PLY file of the same vertices, with a vertex property 'density': wanted vertices "
                 "per area, relative to what they would be.")
      ->type_name("FILE.ply");
  add_options(app, chain.declare());
  app.add_flag("--no-evaluate", no_evaluate, "Do not measure the result.");
  for (const Stage* stage : chain.stages()) {
    add_options(*app.add_option_group("Stage " + stage->name, stage->summary), stage->options);
  }
  shell.add_to(app);
}

void RemeshCommand::check() const {
  check_output_path(PortKind::quads, output);
  std::vector<NamedFile> read = {{"input", input}};
  for (const SideFile& file : side_files())
    read.push_back({"input '" + file.port + "'", file.path});
  check_files(read, output, shell.report_path);
  if (!keep.empty()) {
    read.push_back({"output", output});
    read.push_back({"report", shell.report_path});
    KeptFolder(keep, chain.stages()).check(read);
  }
  chain.check_goals();
  if (no_evaluate && !chain.evaluate.option("evaluate-tolerance").value().empty()) {
    throw UsageError("--evaluate-tolerance takes what --no-evaluate leaves out; give one of them");
  }
}

std::vector<SideFile> RemeshCommand::side_files() const {
  std::vector<SideFile> given;
  for (const SideFile* file : {&feature_edges, &guides, &density}) {
    if (!file->path.empty()) given.push_back(*file);
  }
  return given;
}

Provenance RemeshCommand::without_inputs() {
  Provenance whole;
  whole.stage = "remesh";
  for (const Stage* stage : chain.stages()) {
    if (stage == &chain.evaluate) continue;
    const Provenance part = provenance_of(*stage);
    whole.stage_version += part.stage_version;
    whole.options.insert(whole.options.end(), part.options.begin(), part.options.end());
  }
  const OptionList own = chain.declare();
  Chain untouched;
  const OptionList defaults = untouched.declare();
  for (std::size_t i = 0; i < own.size(); ++i) {
    whole.options.push_back({own[i].name, own[i].value(), own[i].value() == defaults[i].value()});
  }
  return whole;
}

void RemeshCommand::provide(Session& session, const std::string& port, PortKind kind,
                            const std::string& path) {
  asked.inputs.push_back({port, content_digest(path)});
  session.provide(port, load_value(kind, path), path, asked.inputs.back().digest);
}

void RemeshCommand::run() {
  check();
  asked = without_inputs();
  Repro repro{shell.repro, "strake remesh", {input}, [this] { return asked; }, shell.log_format()};
  for (const SideFile& file : side_files()) repro.inputs.emplace_back(file.path);
  with_repro(repro, [this] { make_output(); });
}

void RemeshCommand::make_output() {
  ConsoleObserver console = shell.console();
  console.begin("strake");
  console.report("reading " + input, 0);
  Session session(console);
  provide(session, "input", PortKind::polygons, input);
  for (const SideFile& file : side_files()) provide(session, file.port, file.kind, file.path);
  if (!keep.empty()) {
    session.keep_with(
        KeptFolder(keep, chain.stages()).keeper(),
        [](const Value& value, const TriMesh* mesh) { return content_of(value, mesh); });
  }
  const std::string port = chain.run(session);
  if (!keep.empty()) KeptFolder(keep, chain.stages()).end(port);
  const Report* measures = no_evaluate ? nullptr : &chain.measure(session, port);
  const QuadMesh& quads = session.get<QuadMesh>(port);
  // Written first, and there last: where one of the two cannot be written there is neither.
  std::optional<AtomicFile> report;
  if (!shell.report_path.empty()) {
    write_text(report.emplace(shell.report_path), records_json(session.records()));
  }
  save_result(output, quads, input, asked);
  if (report) report->commit();
  if (shell.verbose) {
    for (const StageRecord& record : session.records()) {
      console.say("\n" + record.provenance.stage + "\n" + report_text(record.report));
    }
  }
  if (!shell.quiet) std::fputs(summary_text(output, quads.mesh, measures).c_str(), stdout);
}

}  // namespace

void add_remesh_command(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("remesh", "Remesh a surface with quads along its curvature.");
  command->footer(kExamples);
  const auto remesh = std::make_shared<RemeshCommand>();
  remesh->add_to(*command);
  command->callback([remesh, &chosen] {
    chosen = [remesh] {
      end_soon_after_interrupts("strake", remesh->shell.log_format());
      run_with_threads(remesh->shell.threads, [&] { remesh->run(); });
      return 0;
    };
  });
}

}  // namespace strake
