#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/artifact/store/store.h"
#include "common/core/error.h"
#include "strake/commands.h"
#include "strake/run/old_runs.h"
#include "strake/run/pipeline_options.h"
#include "strake/run/survey.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

struct GcCommand {
  PipelineOptions pipeline;
  std::string older_than;
  std::string max_size;
  bool unreachable = false;
  bool dry_run = false;

  int run() const;

 private:
  [[nodiscard]] std::set<fs::path> reachable(const Description& description,
                                             const Store& store) const;
  void remove(const Store& store, const Store::Listed& listed, const char* why,
              double& freed) const;
};

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

double amount(const std::string& text, const std::optional<double>& value, const char* option,
              const char* example) {
  if (value) return *value;
  throw UsageError(
      fmt::format("{} '{}' is none; write e.g. {}, a number and a unit", option, text, example));
}

/// Folders of what the pipeline makes as it stands now. Where that is not known yet, since
/// something before it has to be run first, folders of all that it may turn out to be.
std::set<fs::path> GcCommand::reachable(const Description& description, const Store& store) const {
  const Plan plan = make_plan(description, pipeline.selection(description));
  KnownDigests digests(store);
  const std::vector<StepState> states = survey(plan, store, digests, {}, Store::Check::stamp);
  std::set<fs::path> folders;
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const Step& step = plan.steps[s];
    if (states[s].key) {
      folders.insert(EntryName{step.model, step.program, *states[s].key}.folder());
      continue;
    }
    const std::string prefix = EntryName{step.model, step.program, ""}.folder().string();
    for (const Store::Listed& listed : store.list(step.model)) {
      if (listed.folder.string().rfind(prefix, 0) == 0) folders.insert(listed.folder);
    }
  }
  return folders;
}

void GcCommand::remove(const Store& store, const Store::Listed& listed, const char* why,
                       double& freed) const {
  if (!dry_run && !store.remove(listed.folder)) {
    fmt::print("kept     {} (somebody is making it)\n", listed.folder.string());
    return;
  }
  fmt::print("{} {} ({}, {})\n", dry_run ? "would go" : "removed ", listed.folder.string(),
             bytes_text(static_cast<double>(listed.bytes)), why);
  freed += static_cast<double>(listed.bytes);
}

int GcCommand::run() const {
  if (older_than.empty() && max_size.empty() && !unreachable) {
    throw UsageError("say what may go: --unreachable, --older-than 30d, --max-size 10GB");
  }
  const double age_s = older_than.empty()
                           ? std::numeric_limits<double>::infinity()
                           : amount(older_than, parse_seconds(older_than), "--older-than", "30d");
  double room = max_size.empty() ? std::numeric_limits<double>::infinity()
                                 : amount(max_size, parse_bytes(max_size), "--max-size", "10GB");
  std::optional<Description> description;  // of no use where the store is named, as for many files
  if (unreachable || pipeline.store.empty()) description = pipeline.read();
  const fs::path folder = description ? description->store : pipeline.named_store();
  std::error_code ignored;
  if (!pipeline.store.empty() && !fs::exists(folder, ignored)) {
    throw InputError(fmt::format("--store '{}': there is no such folder", folder.string()));
  }
  const Store store(folder, dry_run ? Store::Access::look_only : Store::Access::full);
  store.check_format();
  store.require_own();
  const std::set<fs::path> needed =
      unreachable ? reachable(*description, store) : std::set<fs::path>();

  std::vector<Store::Listed> all = store.list();
  std::stable_sort(all.begin(), all.end(), [](const Store::Listed& a, const Store::Listed& b) {
    return a.used_ns > b.used_ns;  // what was used last stays longest
  });
  const std::int64_t now = now_ns();
  double freed = 0;
  std::size_t kept = 0;
  for (const Store::Listed& listed : all) {
    const auto bytes = static_cast<double>(listed.bytes);
    const double unused_s = static_cast<double>(now - listed.used_ns) * 1e-9;
    if (unreachable && needed.count(listed.folder) == 0) {
      remove(store, listed, "not needed by the pipeline", freed);
    } else if (unused_s > age_s) {
      remove(store, listed, "not used for long", freed);
    } else if (bytes > room) {
      room = 0;  // whatever was used less recently goes too
      remove(store, listed, "the store would be too large", freed);
    } else {
      room -= bytes;
      if (listed.entry) ++kept;  // else what a failed step has left
    }
  }
  if (!dry_run) {
    remove_old_runs(store, kOldRun);
    store.empty_trash();
  }
  fmt::print("{} {}, {} results left\n", dry_run ? "would free" : "freed", bytes_text(freed), kept);
  return 0;
}

}  // namespace

void add_gc_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("gc", "Remove results from the store.");
  command->footer(
      "Examples:\n  strake gc --unreachable --dry-run\n  strake gc --older-than 30d --max-size "
      "50GB\n  strake gc --store /scratch/store --older-than 30d");
  const auto gc = std::make_shared<GcCommand>();
  gc->pipeline.add_file_to(*command);
  command->add_flag("--unreachable", gc->unreachable,
                    "What the pipeline file, as it is now, does not need.");
  command->add_option("--older-than", gc->older_than, "What was not used for so long.")
      ->type_name("TIME");
  command
      ->add_option("--max-size", gc->max_size,
                   "What was used least recently, until the rest fits into this.")
      ->type_name("SIZE");
  command->add_flag("-n,--dry-run", gc->dry_run, "Say what would go, and remove nothing.");
  command->callback([gc, &chosen] { chosen = [gc] { return gc->run(); }; });
}

}  // namespace strake
