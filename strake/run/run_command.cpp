#include <fmt/format.h>
#include <sys/sysinfo.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/core/error.h"
#include "strake/commands.h"
#include "strake/run/ninja_engine.h"
#include "strake/run/pipeline_options.h"
#include "strake/run/run_display.h"
#include "strake/run/run_folder.h"
#include "strake/run/survey.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

/// How often a run starts over after an input turned out to be damaged.
constexpr int kMostRounds = 3;
/// Share of the machine's memory that steps may use together unless told otherwise.
constexpr double kMemoryShare = 0.9;
/// No exit code of a program: an input was damaged, so the run starts over.
constexpr int kDamaged = -1;

std::int64_t machine_memory() {
  struct sysinfo info = {};
  ::sysinfo(&info);
  return static_cast<std::int64_t>(kMemoryShare * static_cast<double>(info.totalram) *
                                   info.mem_unit);
}

std::int64_t processors() { return std::max(1u, std::thread::hardware_concurrency()); }

struct RunCommand {
  PipelineOptions pipeline;
  std::int64_t jobs = 0;
  std::string memory;
  bool dry_run = false;
  bool explain = false;
  bool keep_going = false;
  bool verify = false;
  bool quiet = false;
  std::string from;
  std::vector<std::string> forced;

  void add_to(CLI::App& app);
  int run();

 private:
  void refuse_what_lies_before(const Plan& plan, const std::vector<StepState>& states) const;
  void print_plan(const Plan& plan, const std::vector<StepState>& states) const;
  [[nodiscard]] std::int64_t threads_for(const std::vector<StepOrder>& orders) const;
  [[nodiscard]] RunSettings settings(const Plan& plan) const;
  int run_stale(const Plan& plan, const std::vector<StepState>& states, const Store& store) const;
};

void RunCommand::add_to(CLI::App& app) {
  pipeline.add_to(app);
  add_options(app, {{.name = "jobs",
                     .target = &jobs,
                     .unit = "",
                     .help = "Steps to run at once; 0 for as many as there are processors.",
                     .min = 0,
                     .max = 4096}});
  app.add_option("--memory", memory,
                 "Memory that steps may use together, e.g. 16GB; others wait. Default: nine tenths "
                 "of the machine's.")
      ->type_name("SIZE");
  app.add_flag("-n,--dry-run", dry_run, "Say what would be run, and run nothing.");
  app.add_flag("--explain", explain, "Say of every step why it is run or not.");
  app.add_option("--from", from, "Run nothing before this stage: what it needs must be there.")
      ->type_name("STAGE");
  app.add_option("--force", forced, "Run this stage even where its results are in the store.")
      ->type_name("STAGE")
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("-k,--keep-going", keep_going, "After a failure, run what does not depend on it.");
  app.add_flag("--verify", verify, "Read all that is in the store and check its bytes.");
  app.add_flag("-q,--quiet", quiet, "Say nothing but errors.");
}

void RunCommand::refuse_what_lies_before(const Plan& plan,
                                         const std::vector<StepState>& states) const {
  if (from.empty()) return;
  std::set<std::size_t> allowed;  // steps of that stage, and all that follow from them
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const std::vector<std::size_t> needs = needs_of(plan.steps[s]);
    const bool follows = std::any_of(needs.begin(), needs.end(),
                                     [&](std::size_t need) { return allowed.count(need) != 0; });
    if (plan.steps[s].rule == from || follows) allowed.insert(s);
  }
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    if (allowed.count(s) != 0 || states[s].status != StepState::Status::stale) continue;
    const auto& follower = *std::find_if(
        plan.steps.begin(), plan.steps.end(),
        [&](const Step& step) { return step.rule == from && step.model == plan.steps[s].model; });
    throw PreconditionError(fmt::format(
        "--from {}: '{}' is not in the store, and '{}' may need it ({}); run without --from first",
        from, plan.steps[s].title, follower.title, states[s].reason));
  }
}

void RunCommand::print_plan(const Plan& plan, const std::vector<StepState>& states) const {
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const StepState& state = states[s];
    const bool stale = state.status == StepState::Status::stale;
    if (state.status == StepState::Status::unneeded || (!stale && !explain)) continue;
    fmt::print("{} {}{}\n", stale ? "run   " : "cached", plan.steps[s].title,
               explain ? ": " + state.reason : "");
  }
}

std::int64_t RunCommand::threads_for(const std::vector<StepOrder>& orders) const {
  // Steps of one rule run at once at best; they share the processors.
  std::map<std::string, std::int64_t> abreast;
  std::int64_t most = 1;
  for (const StepOrder& order : orders) most = std::max(most, ++abreast[order.program]);
  const std::int64_t at_once = std::min(most, jobs > 0 ? jobs : processors());
  return std::max<std::int64_t>(1, processors() / at_once);
}

RunSettings RunCommand::settings(const Plan& plan) const {
  RunSettings settings{plan.store, machine_memory(), keep_going};
  if (!memory.empty()) {
    const std::optional<double> bytes = parse_bytes(memory);
    if (!bytes || *bytes < 1) {
      throw UsageError("--memory '" + memory + "' is no amount of memory; write e.g. 16GB");
    }
    settings.memory = static_cast<std::int64_t>(*bytes);
  }
  return settings;
}

int RunCommand::run_stale(const Plan& plan, const std::vector<StepState>& states,
                          const Store& store) const {
  const std::vector<StepOrder> orders = [&] {
    std::vector<StepOrder> stale = stale_orders(plan, states, 0);
    const std::int64_t threads = threads_for(stale);
    for (StepOrder& order : stale) {
      if (order.threads == 0) order.threads = threads;
    }
    return stale;
  }();
  const RunFolder folder = RunFolder::create(store, settings(plan));
  for (const StepOrder& order : orders) folder.write_order(order);
  RunDisplay display(folder, orders, quiet);
  run_with_ninja(folder, orders, jobs > 0 ? jobs : processors(), [&] { display.update(); });
  display.finish();
  if (!quiet) std::fputs(run_table(folder, orders).c_str(), stdout);
  int worst = 0;
  bool damaged = false;
  for (const StepOrder& order : orders) {
    const std::optional<StepOutcome> outcome = folder.outcome(order.id);
    if (outcome && outcome->kind == StepOutcome::Kind::damaged) damaged = true;
    if (outcome && worst == 0) worst = outcome->exit_code;
    if (!outcome && worst == 0) worst = static_cast<int>(ExitCode::internal);
  }
  if (interrupt_requested()) throw Interrupted();
  return damaged ? kDamaged : worst;
}

int RunCommand::run() {
  const Description description = pipeline.read();
  const Plan plan = make_plan(description, pipeline.selection(description));
  const Store store(plan.store);
  std::set<std::string> forced_rules(forced.begin(), forced.end());
  check_rule_name(from, description, "--from");
  for (const std::string& name : forced) check_rule_name(name, description, "--force");

  for (int round = 1;; ++round) {
    KnownDigests digests(store.side_folder("digests"));
    const std::vector<StepState> states = survey(
        plan, store, digests, forced_rules, verify ? Store::Check::content : Store::Check::stamp);
    refuse_what_lies_before(plan, states);
    for (const StepState& state : states) {
      if (!quiet && state.reason.rfind("damaged", 0) == 0) {
        fmt::print(stderr, "strake: warning: {}; it is made again\n", state.reason);
      }
    }
    if (dry_run || (explain && round == 1)) print_plan(plan, states);
    const auto stale = std::count_if(states.begin(), states.end(), [](const StepState& state) {
      return state.status == StepState::Status::stale;
    });
    const auto cached = std::count_if(states.begin(), states.end(), [](const StepState& state) {
      return state.status == StepState::Status::cached;
    });
    if (dry_run) {
      fmt::print("{} steps to run, {} in the store\n", stale, cached);
      return 0;
    }
    for (const StepState& state : states) {
      if (state.entry) store.touch(*state.entry);
    }
    int exit_code = 0;
    if (stale > 0) {
      store.prepare();
      exit_code = run_stale(plan, states, store);
    }
    for (const PendingDelivery& pending : pending_deliveries(plan, states, digests)) {
      deliver(states[pending.step].entry->file, pending.file);
    }
    if (exit_code == kDamaged && round < kMostRounds) {
      forced_rules.clear();
      continue;
    }
    if (!quiet) fmt::print("{} steps run, {} in the store\n", stale, cached);
    return exit_code == kDamaged ? static_cast<int>(ExitCode::bad_input) : exit_code;
  }
}

}  // namespace

void add_run_command(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("run", "Build what a pipeline file describes, and only what is stale.");
  const auto run = std::make_shared<RunCommand>();
  run->add_to(*command);
  command->callback([run, &chosen] { chosen = [run] { return run->run(); }; });
}

}  // namespace strake
