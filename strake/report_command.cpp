#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "common/stage/value.h"
#include "strake/commands.h"
#include "strake/report/page.h"
#include "strake/report/viewer.h"
#include "strake/run/pipeline_options.h"
#include "strake/run/target_results.h"

namespace strake {
namespace {

struct ReportCommand {
  std::vector<std::string> runs;
  std::string pipeline;
  std::string output;
  std::int64_t threads = 0;
};

void require_viewer() {
  if (!report::viewer_page().empty()) return;
  throw PreconditionError(
      "this program was built without the viewer that reports need; run 'scripts/setup --all' (or "
      "install nodejs and npm), then scripts/build_viewer, and build strake again");
}

/// Gives runs from folders of the same name that of the path as it was given.
void tell_apart(std::vector<report::RunFiles>& runs, const std::vector<std::string>& folders) {
  std::map<std::string, int> count;
  for (const report::RunFiles& run : runs) ++count[run.name];
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (count[runs[i].name] > 1) runs[i].name = folders[i];
  }
}

std::vector<report::RunFiles> read_runs(const ReportCommand& command) {
  std::vector<report::RunFiles> runs;
  if (command.pipeline.empty()) {
    if (command.runs.empty()) {
      throw UsageError(
          "name a folder that 'strake remesh --keep FOLDER' made, or a pipeline: --pipeline FILE");
    }
    for (const std::string& folder : command.runs) runs.push_back(report::read_run(folder));
    tell_apart(runs, command.runs);
    return runs;
  }
  PipelineOptions pipeline;
  pipeline.file = command.pipeline;
  pipeline.targets = command.runs;
  const Description description = pipeline.read();
  for (const TargetResults& target : target_results(description, pipeline.selection(description))) {
    runs.push_back(report::read_run(target.name, target.files, target.seconds));
  }
  return runs;
}

int make_report(const ReportCommand& command) {
  if (std::filesystem::path(command.output).extension() != ".html") {
    throw UsageError("--output '" + command.output + "': the name of a report ends in .html");
  }
  check_place("output", command.output);
  const std::vector<report::RunFiles> runs = read_runs(command);
  require_viewer();
  const std::string page = report::fill_page(report::viewer_page(), report::describe_runs(runs));
  write_text(command.output, page);
  fmt::print("{}: {} run{}, {:.1f} MB\n", command.output, runs.size(), runs.size() == 1 ? "" : "s",
             static_cast<double>(page.size()) / 1e6);
  return 0;
}

}  // namespace

void add_report_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "report", "Show runs in one HTML file: surfaces, curvature, lines, results, figures.");
  command->footer(
      "Examples:\n  strake report work -o report.html\n  strake report fine coarse -o "
      "compared.html\n  strake report --pipeline pipeline.yaml part/fine -o report.html");
  const auto wanted = std::make_shared<ReportCommand>();
  command
      ->add_option(
          "runs", wanted->runs,
          "folders of runs, as 'strake remesh --keep' leaves them; with --pipeline MODEL or "
          "MODEL/VARIANT, default: everything. Several are compared.")
      ->type_name("FOLDER");
  command
      ->add_option("--pipeline", wanted->pipeline,
                   "Show what the store holds of a pipeline file, with the times that steps took.")
      ->type_name("FILE");
  command->add_option("-o,--output", wanted->output, "page to write, .html")
      ->type_name("FILE")
      ->required();
  add_options(*command,
              {{.name = "threads",
                .target = &wanted->threads,
                .unit = "",
                .help = "Threads to use; 0 takes every processor. Never changes a result.",
                .min = 0,
                .max = 4096,
                .affects_result = false}});
  command->callback([wanted, &chosen] {
    chosen = [wanted] {
      int exit_code = 0;
      run_with_threads(wanted->threads, [&] { exit_code = make_report(*wanted); });
      return exit_code;
    };
  });
}

}  // namespace strake
