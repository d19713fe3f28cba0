#include "strake/run/pipeline_options.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>

#include "common/core/error.h"
#include "common/core/text.h"
#include "strake/run/rules.h"
#include "strake/run/run_paths.h"

namespace strake {

namespace fs = std::filesystem;

void PipelineOptions::add_to(CLI::App& app) {
  app.add_option("targets", targets, "MODEL or MODEL/VARIANT; default: everything")
      ->type_name("TARGET");
  add_file_to(app);
  app.add_option("--until", until, "Last stage of interest.")->type_name("STAGE");
  app.add_option("--set", settings, "An option for this time only: trace.seed=7.")
      ->type_name("STAGE.OPTION=VALUE")
      ->take_all()
      ->allow_extra_args(false);
}

void PipelineOptions::add_file_to(CLI::App& app) {
  app.add_option("-f,--file", file, "Pipeline file.")->type_name("FILE")->capture_default_str();
  app.add_option("--store", store, "Folder of the results, instead of the one in the file.")
      ->type_name("FOLDER");
}

Description PipelineOptions::read() const {
  Description description = read_description(file);
  if (!store.empty()) description.store = named_store();
  return description;
}

fs::path PipelineOptions::named_store() const {
  const fs::path folder = without_dots(fs::absolute(store) / "").parent_path();
  const std::string unfit = unfit_for_runs(folder);
  if (unfit.empty()) return folder;
  throw UsageError(fmt::format("--store '{}': the path of a store cannot have {} in it",
                               on_one_line(folder.string()), unfit));
}

Selection PipelineOptions::selection(const Description& description) const {
  Selection selection;
  selection.targets = targets;
  if (!until.empty()) {
    check_rule_name(until, description, "--until");
    selection.until = until;
  }
  for (const std::string& text : settings) {
    selection.settings.push_back(parse_setting(description, text));
  }
  check_together(selection.settings);
  return selection;
}

void check_rule_name(const std::string& name, const Description& description,
                     const std::string& option) {
  std::vector<std::string> known;
  for (const Rule& rule : description.rules) known.push_back(rule.name);
  if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) return;
  throw UsageError(fmt::format("{}: there is no stage '{}'{}; stages: {}", option, name,
                               suggestion(name, known), fmt::join(known, ", ")));
}

}  // namespace strake
