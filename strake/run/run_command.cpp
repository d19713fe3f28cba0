#include "strake/run/run_command.h"

#include <fmt/format.h>
#include <sys/sysinfo.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/artifact/store/folder_lock.h"
#include "common/core/error.h"
#include "common/stage/console.h"
#include "strake/commands.h"
#include "strake/run/ninja_engine.h"
#include "strake/run/old_runs.h"
#include "strake/run/run_display.h"
#include "strake/run/slurm_engine.h"
#include "strake/run/slurm_options.h"
#include "strake/run/slurm_scripts.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

/// How often in a row a run starts over without having made anything new, where inputs turn out to
/// be damaged or gone.
constexpr int kMostFruitless = 3;
/// Share of the machine's memory that steps may use together unless told otherwise.
constexpr double kMemoryShare = 0.9;

std::int64_t machine_memory() {
  struct sysinfo info = {};
  ::sysinfo(&info);
  return static_cast<std::int64_t>(kMemoryShare * static_cast<double>(info.totalram) *
                                   info.mem_unit);
}

/// Has a folder that results go to, or are found in, say that it is a store.
void mark_as_store(const Store& store, bool is_written, bool has_results) {
  if (is_written) return store.prepare();
  if (!has_results) return;
  try {
    store.prepare();
  } catch (const InputError&) {
    return;  // one that is there to be read only stays as it is
  }
}

std::int64_t processors() { return std::max(1u, std::thread::hardware_concurrency()); }

}  // namespace

void RunCommand::add_common_options(CLI::App& app) {
  pipeline.add_to(app);
  app.add_flag("-n,--dry-run", dry_run, "Say what would be run, and run nothing.");
  app.add_flag("--explain", explain, "Say of every step why it is run or not.");
  app.add_option("--from", from, "Run nothing before this stage: what it needs must be there.")
      ->type_name("STAGE");
  app.add_option("--force", forced, "Run this stage even where its results are in the store.")
      ->type_name("STAGE")
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("--verify", verify, "Read all that is in the store and check its bytes.");
  app.add_flag("-q,--quiet", quiet, "Say nothing but errors.");
}

void RunCommand::add_local_options(CLI::App& app) {
  app.add_option("-j,--jobs", jobs, "Steps to run at once; 0 for as many as there are processors.")
      ->type_name("N")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_option("--memory", memory,
                 "Memory that steps may use together, e.g. 16GB; others wait. Default: nine tenths "
                 "of the machine's.")
      ->type_name("SIZE");
  app.add_flag("-k,--keep-going", keep_going,
               "After a failure, run what does not depend on it. Slurm always does.");
}

void RunCommand::add_slurm_options(CLI::App& app) {
  app.add_flag("--wait", wait, "Wait until all jobs have ended, and show how they go.");
  app.add_option("--sbatch", sbatch, "More options for sbatch, e.g. \"--partition=long\".")
      ->type_name("OPTIONS")
      ->take_all()
      ->allow_extra_args(false);
}

std::int64_t RunCommand::wanted_memory() const {
  if (memory.empty()) return machine_memory();
  const std::optional<double> bytes = parse_bytes(memory);
  if (!bytes || *bytes < 1) {
    throw UsageError("--memory '" + memory +
                     "' is no amount of memory; write e.g. 16GB, a number and a unit");
  }
  return static_cast<std::int64_t>(*bytes);
}

/// Refuses what the engine would silently not do, and what it could not take.
void RunCommand::check_engine_options() const {
  if (engine == kSlurm) {
    if (jobs != 0 || !memory.empty()) {
      throw UsageError(
          "--jobs and --memory are for the local engine; on a cluster Slurm decides what fits (see "
          "'resources' in the pipeline file, and --sbatch)");
    }
  } else if (wait || !sbatch.empty()) {
    throw UsageError("--wait and --sbatch are for --engine slurm");
  } else {
    static_cast<void>(wanted_memory());
  }
}

void RunCommand::refuse_empty_range(const Plan& plan) const {
  const auto is_first = [&](const Step& step) { return step.rule == from; };
  if (from.empty() || std::any_of(plan.steps.begin(), plan.steps.end(), is_first)) return;
  throw UsageError(fmt::format(
      "--from {0} --until {1} leaves nothing to run: '{1}' does not need '{0}'; leave one of them "
      "out",
      from, pipeline.until));
}

void RunCommand::refuse_what_lies_before(const Plan& plan,
                                         const std::vector<StepState>& states) const {
  if (from.empty()) return;
  std::set<std::size_t> allowed;  // steps of that stage, and all that follow from them
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const std::vector<std::size_t> needs = needs_of(plan.steps[s]);
    const bool follows = std::any_of(needs.begin(), needs.end(),
                                     [&](std::size_t need) { return allowed.count(need) != 0; });
    if (plan.steps[s].rule != from && !follows) continue;
    allowed.insert(s);
    allowed.insert(plan.steps[s].parts.begin(), plan.steps[s].parts.end());
  }
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    if (allowed.count(s) != 0 || states[s].status != StepState::Status::stale) continue;
    throw PreconditionError(
        fmt::format("--from {}: '{}' lies before it and is not in the store ({}); run without "
                    "--from first",
                    from, plan.steps[s].title, states[s].reason));
  }
}

std::set<std::string> RunCommand::forced_steps(const Plan& plan) const {
  std::set<std::string> steps;
  for (const Step& step : plan.steps) {
    if (std::find(forced.begin(), forced.end(), step.rule) != forced.end()) steps.insert(step.id);
  }
  return steps;
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

void warn_of_idle(const std::vector<Setting>& settings) {
  for (const Setting& setting : settings) {
    fmt::print(
        stderr,
        "strake: warning: --set {0}.{1} changes nothing: no step of '{0}' is among those that "
        "are wanted; leave --until out, or name '{0}' there\n",
        setting.rule, setting.option);
  }
}

std::int64_t RunCommand::threads_for(const std::vector<StepOrder>& orders) const {
  // Steps of one program wait for the same before them, so these are taken to run at once.
  std::map<std::string, std::int64_t> abreast;
  std::int64_t most = 1;
  for (const StepOrder& order : orders) most = std::max(most, ++abreast[order.program]);
  const std::int64_t at_once = std::min(most, jobs > 0 ? jobs : processors());
  return std::max<std::int64_t>(1, processors() / at_once);
}

RunSettings RunCommand::settings(const Description& description) const {
  RunSettings settings;
  settings.store = description.store;
  settings.keep_going = keep_going;
  settings.pipeline = description.file;
  settings.targets = pipeline.targets;
  settings.until = pipeline.until;
  settings.options = pipeline.settings;
  if (engine == kSlurm) return settings;
  settings.memory = wanted_memory();
  return settings;
}

RunCommand::Round RunCommand::run_locally(const Description& description, const Plan& plan,
                                          const std::vector<StepState>& states) const {
  const std::vector<StepOrder> orders = [&] {
    std::vector<StepOrder> stale = stale_orders(plan, states, 0);
    const std::int64_t threads = threads_for(stale);
    for (StepOrder& order : stale) {
      if (order.threads == 0) order.threads = threads;
    }
    return stale;
  }();
  const Store store(plan.store);
  const RunFolder folder = RunFolder::create(store, settings(description));
  const FolderLock going_on(folder.path());
  remove_old_runs(store);
  for (const StepOrder& order : orders) folder.write_order(order);
  RunDisplay display(folder, orders, quiet);
  const std::string complaint =
      run_with_ninja(folder, orders, jobs > 0 ? jobs : processors(), [&] { display.update(); });
  display.finish();
  return conclude(folder, orders, complaint);
}

RunCommand::Round RunCommand::run_on_cluster(const Description& description, const Plan& plan,
                                             const std::vector<StepState>& states) const {
  check_slurm_takes(plan.store);
  std::vector<std::string> options = description.sbatch_options;
  for (const std::string& text : sbatch) {
    options.push_back(checked_sbatch_options(text, {"--sbatch " + text}));
  }
  const std::vector<QueuedTask> queue = script_only ? std::vector<QueuedTask>() : slurm_queue();
  const Store store(plan.store);
  const std::vector<StepOrder> orders = stale_orders(plan, states, 1);
  const RunFolder folder = RunFolder::create(store, settings(description));
  const FolderLock going_on(folder.path());  // with --wait
  remove_old_runs(store);
  for (const StepOrder& order : orders) folder.write_order(order);
  const fs::path scripts =
      script_folder.empty() ? folder.path() / "slurm" : fs::absolute(script_folder);
  write_slurm_scripts(scripts, folder, orders, slurm_arrays(orders), options);
  if (script_only) {
    if (!quiet) fmt::print("submit with {}\n", (scripts / kSubmitScript).string());
    return {};
  }
  const std::size_t cancelled = cancel_superseded(queue, store, folder.settings());
  if (cancelled > 0 && !quiet) {
    fmt::print("cancelled {} waiting tasks of earlier submissions\n", cancelled);
  }
  const std::vector<std::string> submitted = submit_to_slurm(scripts);
  if (!quiet) {
    fmt::print(
        "jobs    {0}\n"
        "follow  squeue --jobs={1}\n"
        "        strake status{2}\n"
        "logs    {3}\n"
        "stop    scancel {0}\n"
        "resume  run the same command again, now or after failures\n",
        fmt::join(submitted, " "), fmt::join(submitted, ","),
        pipeline.file == PipelineOptions().file ? "" : " --file " + pipeline.file,
        (folder.path() / "logs").string());
    std::fflush(stdout);
  }
  if (!wait) return {};
  RunDisplay display(folder, orders, quiet);
  wait_for_slurm(folder, orders, [&] { display.update(); });
  display.finish();
  if (interrupt_requested() && !quiet) write_stderr("strake: the jobs go on\n");
  return conclude(folder, orders, "see the logs in " + (folder.path() / "logs").string());
}

/// Prints what became of the steps.
/// \param complaint  what there is to say where steps were not run though none has failed
RunCommand::Round RunCommand::conclude(const RunFolder& folder,
                                       const std::vector<StepOrder>& orders,
                                       const std::string& complaint) const {
  if (!quiet) std::fputs(run_table(folder, orders).c_str(), stdout);
  Round round;
  bool complete = true;
  for (const StepOrder& order : orders) {
    const std::optional<StepOutcome> outcome = folder.outcome(order.id);
    if (!outcome) {
      complete = false;
      continue;
    }
    if (outcome->kind == StepOutcome::Kind::damaged) round.damaged = true;
    if (!outcome->file.empty()) round.made.insert(order.id);
    if (round.exit_code == 0) round.exit_code = outcome->exit_code;
  }
  if (interrupt_requested()) throw Interrupted();
  if (!round.damaged && round.exit_code == 0 && !complete) {
    throw Error(ExitCode::internal, "the run was cut short; run again to go on\n" + complaint);
  }
  return round;
}

/// Writes what the user wants of steps that had been made before.
void RunCommand::write_outputs(const Plan& plan, const std::vector<StepState>& states,
                               KnownDigests& digests) const {
  for (const PendingDelivery& pending : pending_deliveries(plan, states, digests)) {
    deliver(states[pending.step].entry->file, pending.file);
    if (!quiet) fmt::print("wrote {}\n", shown_path(pending.file));
  }
}

/// What became of the stale steps, for the last line.
const char* RunCommand::done_to_steps() const {
  if (script_only) return "written to scripts";
  return engine == kSlurm && !wait ? "submitted" : "run";
}

int RunCommand::run() {
  check_engine_options();
  const Description description = pipeline.read();
  const Selection selection = pipeline.selection(description);
  const Plan plan = make_plan(description, selection);
  if (!quiet) warn_of_idle(idle_settings(plan, selection.settings));
  const Store store(plan.store, dry_run ? Store::Access::look_only : Store::Access::full);
  store.check_format();
  check_rule_name(from, description, "--from");
  refuse_empty_range(plan);
  for (const std::string& name : forced) check_rule_name(name, description, "--force");
  std::set<std::string> to_force = forced_steps(plan);

  std::set<std::string> made;
  int fruitless = 0;
  for (bool is_first = true;; is_first = false) {
    KnownDigests digests(store);
    const std::vector<StepState> states = survey(
        plan, store, digests, to_force, verify ? Store::Check::content : Store::Check::stamp);
    refuse_what_lies_before(plan, states);
    for (const StepState& state : states) {
      if (!quiet && state.damaged) {
        write_stderr(fmt::format("strake: warning: {}; it is made again\n", state.reason));
      }
    }
    if (dry_run || (explain && is_first)) print_plan(plan, states);
    const auto stale = std::count_if(states.begin(), states.end(), [](const StepState& state) {
      return state.status == StepState::Status::stale;
    });
    const auto cached = std::count_if(states.begin(), states.end(), [](const StepState& state) {
      return state.status == StepState::Status::cached;
    });
    if (dry_run) {
      for (const std::string& file : files_to_write(plan, states, digests)) {
        fmt::print("write  {}\n", shown_path(file));
      }
      fmt::print("{} steps to run, {} in the store\n", stale, cached);
      return 0;
    }
    for (std::size_t s = 0; s < states.size(); ++s) {
      if (states[s].entry) store.touch(entry_name(plan.steps[s], states[s]));
    }
    Round round;
    mark_as_store(store, stale > 0, cached > 0);
    if (stale > 0) {
      round = engine == kSlurm ? run_on_cluster(description, plan, states)
                               : run_locally(description, plan, states);
    }
    write_outputs(plan, states, digests);
    if (round.damaged) {
      const std::size_t before = made.size();
      made.merge(round.made);
      fruitless = made.size() > before ? 0 : fruitless + 1;
      if (fruitless == kMostFruitless) {
        throw InputError(
            "inputs of steps keep being changed or damaged while they are in use; see above");
      }
      for (const std::string& step : round.made) to_force.erase(step);
      continue;
    }
    const int exit_code = round.exit_code;
    if (quiet || exit_code != 0) return exit_code;
    if (script_only && stale == 0) {
      fmt::print("nothing is stale: there are no scripts to write, {} steps in the store\n",
                 cached);
    } else {
      fmt::print("{} steps {}, {} in the store\n", stale, done_to_steps(), cached);
    }
    return exit_code;
  }
}

void add_run_command(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("run", "Build what a pipeline file describes, and only what is stale.");
  command->footer(
      "Examples:\n  strake run\n  strake run part/fine --explain\n  strake run --set trace.seed=7 "
      "--until mesh\n  strake run --engine slurm --wait");
  const auto run = std::make_shared<RunCommand>();
  command->add_option("--engine", run->engine, "What runs the steps: this machine, or a cluster.")
      ->check(CLI::IsMember({kLocal, kSlurm}))
      ->capture_default_str();
  run->add_common_options(*command);
  run->add_local_options(*command);
  run->add_slurm_options(*command);
  command->callback([run, &chosen] { chosen = [run] { return run->run(); }; });
}

}  // namespace strake
