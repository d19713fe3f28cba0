#include "strake/run/slurm_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

#include "common/core/error.h"
#include "common/stage/console.h"
#include "strake/run/child_process.h"
#include "strake/run/slurm_scripts.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr int kNotFound = 127;
/// Between looks at the queue; other users want answers from the controller too.
constexpr std::chrono::seconds kQueuePause{5};
constexpr std::chrono::milliseconds kIdlePause{100};

struct Answer {
  int exit_code = 0;
  std::vector<std::string> lines;

  [[nodiscard]] std::string text() const { return fmt::format("{}", fmt::join(lines, "\n")); }
};

Answer ask(const std::vector<std::string>& command) {
  Answer answer;
  ChildProcess child(command);
  answer.exit_code =
      child.wait([&](const std::string& line) { answer.lines.push_back(line); }, [] {}).exit_code;
  return answer;
}

Answer ask_queue() { return ask({"squeue", "--me", "--noheader", "--array", "--format=%F|%T|%Z"}); }

std::vector<QueuedTask> tasks_in(const Answer& answer) {
  std::vector<QueuedTask> tasks;
  for (const std::string& line : answer.lines) {
    const std::size_t state = line.find('|');
    const std::size_t folder = line.find('|', state + 1);
    if (state == std::string::npos || folder == std::string::npos) continue;
    tasks.push_back({line.substr(0, state), line.substr(state + 1, folder - state - 1) == "PENDING",
                     line.substr(folder + 1)});
  }
  return tasks;
}

/// Whether "MODEL" or "MODEL/VARIANT" is among what was asked for.
bool is_covered(const std::string& target, const std::vector<std::string>& asked) {
  return std::any_of(asked.begin(), asked.end(), [&](const std::string& other) {
    return target == other || target.rfind(other + "/", 0) == 0;
  });
}

bool is_superseded(const fs::path& run, const RunSettings& by) {
  try {
    const RunSettings settings = RunFolder(run).settings();
    if (settings.pipeline != by.pipeline || settings.options != by.options) return false;
    if (!by.until.empty() && by.until != settings.until) return false;
    if (by.targets.empty()) return true;
    return !settings.targets.empty() &&
           std::all_of(settings.targets.begin(), settings.targets.end(),
                       [&](const std::string& target) { return is_covered(target, by.targets); });
  } catch (const InputError&) {
    return false;  // nothing is known of it
  }
}

}  // namespace

std::vector<QueuedTask> slurm_queue() {
  const Answer answer = ask_queue();
  if (answer.exit_code == kNotFound) {
    throw InputError(
        "Slurm's commands (squeue, sbatch) are not installed here; submit from a machine of the "
        "cluster, or write the scripts for one with 'strake submit --script-only'");
  }
  if (answer.exit_code != 0) {
    throw InputError("Slurm does not answer; is its controller up? squeue says: " + answer.text());
  }
  return tasks_in(answer);
}

std::size_t cancel_superseded(const std::vector<QueuedTask>& queue, const Store& store,
                              const RunSettings& settings) {
  std::set<std::string> jobs;
  std::size_t tasks = 0;
  for (const QueuedTask& task : queue) {
    std::error_code ignored;  // the queue may know the folder by another name
    const bool is_ours =
        fs::equivalent(task.folder.parent_path(), store.side_folder("runs"), ignored);
    if (!task.waits || !is_ours || !is_superseded(task.folder, settings)) continue;
    jobs.insert(task.job);
    ++tasks;
  }
  if (tasks == 0) return 0;
  std::vector<std::string> command = {"scancel", "--state=PENDING"};
  command.insert(command.end(), jobs.begin(), jobs.end());
  ask(command);  // what has started or ended meanwhile is no harm
  return tasks;
}

std::vector<std::string> submit_to_slurm(const fs::path& scripts) {
  const Answer answer = ask({(scripts / kSubmitScript).string()});
  if (answer.exit_code != 0) {
    if (interrupt_requested()) throw Interrupted();  // the script has taken its jobs back
    throw InputError(
        fmt::format("sbatch refused a job (exit code {}): {}", answer.exit_code, answer.text()));
  }
  std::vector<std::string> jobs;
  for (const std::string& line : answer.lines) {
    const std::string first = line.substr(0, line.find(' '));
    if (!first.empty() && first.find_first_not_of("0123456789") == std::string::npos) {
      jobs.push_back(first);
    } else {
      write_stderr(fmt::format("{}\n", line));  // a warning of sbatch
    }
  }
  return jobs;
}

void wait_for_slurm(const RunFolder& folder, const std::vector<StepOrder>& orders,
                    const std::function<void()>& idle) {
  const auto all_have_ended = [&] {
    const auto has_outcome = [&](const StepOrder& order) {
      return fs::exists(folder.outcome_file(order.id));
    };
    // The cluster may start again what it has interrupted; then it is in the queue.
    const auto is_interrupted = [&](const StepOrder& order) {
      return folder.outcome(order.id).value_or(StepOutcome{}).is_interrupted();
    };
    return std::all_of(orders.begin(), orders.end(), has_outcome) &&
           std::none_of(orders.begin(), orders.end(), is_interrupted);
  };
  const auto is_queued = [&] {
    const Answer answer = ask_queue();
    if (answer.exit_code != 0) return true;  // the controller may come back
    const std::vector<QueuedTask> tasks = tasks_in(answer);
    return std::any_of(tasks.begin(), tasks.end(),
                       [&](const QueuedTask& task) { return task.folder == folder.path(); });
  };
  auto looked = std::chrono::steady_clock::now();
  while (!interrupt_requested() && !all_have_ended()) {
    if (std::chrono::steady_clock::now() - looked > kQueuePause) {
      if (!is_queued()) return;
      looked = std::chrono::steady_clock::now();
    }
    idle();
    std::this_thread::sleep_for(kIdlePause);
  }
}

}  // namespace strake
