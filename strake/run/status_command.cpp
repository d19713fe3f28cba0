#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/artifact/store/store.h"
#include "common/core/error.h"
#include "strake/commands.h"
#include "strake/run/pipeline_options.h"
#include "strake/run/schema.h"
#include "strake/run/survey.h"

namespace strake {
namespace {

struct StatusCommand {
  PipelineOptions pipeline;
  bool steps = false;
  bool verify = false;

  int run() const;
};

const char* status_word(const StepState& state) {
  if (state.status == StepState::Status::cached) return "ready";
  return state.damaged ? "damaged" : "stale";
}

void print_steps(const Plan& plan, const std::vector<StepState>& states) {
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const StepState& state = states[s];
    if (state.status == StepState::Status::unneeded) continue;
    fmt::print("{:8} {}: {}\n", status_word(state), plan.steps[s].title,
               state.entry ? state.entry->file.string() : state.reason);
    if (!state.entry) continue;
    for (const std::string& warning : state.entry->warnings) {
      fmt::print("         warning: {}\n", warning);
    }
  }
}

/// A row per model and variant, a column per stage.
void print_targets(const Plan& plan, const std::vector<StepState>& states) {
  std::vector<std::string> columns;
  std::vector<std::string> rows;
  std::map<std::pair<std::string, std::string>, std::string> cells;
  const auto note = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const Step& step = plan.steps[s];
    if (step.is_part) continue;
    note(columns, step.rule);
    for (const std::string& variant : step.variants) {
      const std::string row = step.model + "/" + variant;
      note(rows, row);
      cells[{row, step.rule}] = status_word(states[s]);
    }
  }
  std::size_t width = 6;
  for (const std::string& row : rows) width = std::max(width, row.size());
  fmt::print("{:{}}", "target", width);
  for (const std::string& column : columns) fmt::print("  {:>8}", column);
  fmt::print("\n");
  for (const std::string& row : rows) {
    fmt::print("{:{}}", row, width);
    for (const std::string& column : columns) {
      const std::string& cell = cells[{row, column}];
      fmt::print("  {:>{}}", cell.empty() ? "-" : cell, std::max<std::size_t>(8, column.size()));
    }
    fmt::print("\n");
  }
}

/// Says how many results have warnings, which are a line each for whoever wants to read them.
void print_warned(const std::vector<StepState>& states) {
  const auto warned = std::count_if(states.begin(), states.end(), [](const StepState& state) {
    return state.entry && !state.entry->warnings.empty();
  });
  if (warned == 0) return;
  fmt::print("results with warnings: {}; 'strake status --steps' shows them\n", warned);
}

/// Names the files that a run would write. \param all  instead of the first and how many more
void print_outputs(const std::vector<std::string>& files, bool all) {
  if (files.empty()) return;
  if (all) {
    for (const std::string& file : files) fmt::print("{:8} {}\n", "to write", shown_path(file));
    return;
  }
  const std::string others = files.size() == 1 ? "" : fmt::format(" and {} more", files.size() - 1);
  fmt::print("outputs missing or out of date: {}{}; 'strake run' writes them\n",
             shown_path(files.front()), others);
}

/// Who asks for a check wants to know by the exit code. \throw InputError where there is damage
void refuse_damage(const Plan& plan, const std::vector<StepState>& states) {
  std::string text;
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    if (!states[s].damaged || states[s].status != StepState::Status::stale) continue;
    text +=
        fmt::format("{}{}: {}", text.empty() ? "" : "\n", plan.steps[s].title, states[s].reason);
  }
  if (!text.empty()) throw InputError(text + "\n'strake run' makes it again");
}

int StatusCommand::run() const {
  const Description description = pipeline.read();
  Selection selection = pipeline.selection(description);
  selection.leave_out_missing = true;
  const Plan plan = make_plan(description, selection);
  const Store store(plan.store);
  store.check_format();
  KnownDigests digests(store);
  const std::vector<StepState> states =
      survey(plan, store, digests, {}, verify ? Store::Check::content : Store::Check::stamp);
  if (steps) {
    print_steps(plan, states);
  } else {
    print_targets(plan, states);
    print_warned(states);
  }
  for (const auto& [model, file] : plan.left_out) {
    fmt::print("{:8} {}: there is no file '{}'\n", "missing", model, file.string());
  }
  print_outputs(files_to_write(plan, states, digests), steps);
  double bytes = 0;
  std::size_t entries = 0;
  for (const Store::Listed& listed : store.list()) {
    bytes += static_cast<double>(listed.bytes);
    if (listed.entry) ++entries;  // else what a failed step has left
  }
  fmt::print("store {}: {} results, {}\n", store.root().string(), entries, bytes_text(bytes));
  if (verify) refuse_damage(plan, states);
  return 0;
}

}  // namespace

void add_status_command(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("status", "Say what of a pipeline is in the store and what is stale.");
  command->footer("Examples:\n  strake status\n  strake status part --steps");
  const auto status = std::make_shared<StatusCommand>();
  status->pipeline.add_to(*command);
  command->add_flag("--steps", status->steps, "A line per step, with the file of its result.");
  command->add_flag("--verify", status->verify, "Read all that is in the store and check it.");
  command->callback([status, &chosen] { chosen = [status] { return status->run(); }; });
}

void add_schema_command(CLI::App& app, Action& chosen) {
  app.add_subcommand("schema", "Print the JSON Schema of pipeline files, for editors.")
      ->footer("Example:\n  strake schema > pipeline.schema.json")
      ->callback([&chosen] {
        chosen = [] {
          std::fputs(pipeline_schema().c_str(), stdout);
          return 0;
        };
      });
}

}  // namespace strake
