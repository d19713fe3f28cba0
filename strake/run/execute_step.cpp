#include "strake/run/execute_step.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <vector>

#include "common/artifact/artifact.h"
#include "common/artifact/digest.h"
#include "common/artifact/store/folder_lock.h"
#include "common/artifact/store/store.h"
#include "common/core/error.h"
#include "common/stage/console.h"
#include "strake/run/child_process.h"
#include "strake/run/memory_gate.h"
#include "strake/run/plan.h"
#include "strake/run/run_folder.h"
#include "strake/run/stage_catalog.h"
#include "strake/run/stage_command.h"
#include "strake/run/survey.h"

namespace strake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::chrono::milliseconds kLockPause{100};
constexpr const char* kTemporaryExtension = ".tmp";
constexpr std::string_view kWarning = "warning: ";

/// An input of a step has other bytes than the run was planned with.
class DamagedInput : public Error {
 public:
  explicit DamagedInput(const std::string& message) : Error(ExitCode::bad_input, message) {}
};

class StepRun {
 public:
  StepRun(const fs::path& run_folder, const std::string& id)
      : folder_(run_folder),
        order_(folder_.order(id)),
        settings_(folder_.settings()),
        store_(settings_.store),
        log_(folder_.log_file(id)) {}

  ~StepRun() {
    std::error_code ignored;
    fs::remove(folder_.progress_file(order_.id), ignored);
  }

  int run() {
    StepOutcome outcome;
    try {
      outcome = make();
      if (outcome.exit_code == 0) {
        for (const std::string& file : order_.deliver_to) deliver(outcome.file, file);
      }
    } catch (const DamagedInput& error) {
      outcome.kind = StepOutcome::Kind::damaged;
      outcome.message = error.what();
      outcome.exit_code = static_cast<int>(error.code());
    } catch (const Error& error) {
      outcome.kind = StepOutcome::Kind::failed;
      outcome.message = error.what();
      outcome.exit_code = static_cast<int>(error.code());
    } catch (const std::exception& error) {
      outcome.kind = StepOutcome::Kind::failed;
      outcome.message = std::string("internal error, please report it: ") + error.what();
      outcome.exit_code = static_cast<int>(ExitCode::internal);
    }
    if (!outcome.message.empty()) log(outcome.message);
    folder_.write_outcome(order_.id, outcome);
    return outcome.exit_code;
  }

 private:
  void log(const std::string& line) { log_ << line << std::endl; }

  void show(const std::string& text) const {
    std::ofstream(folder_.progress_file(order_.id)) << text << '\n';
  }

  /// Finds where inputs from other steps are, and checks the bytes of all of them.
  void resolve(std::vector<OrderedInput>& inputs) {
    for (OrderedInput& input : inputs) {
      if (!input.from.empty()) {
        const std::optional<StepOutcome> made = folder_.outcome(input.from);
        if (!made || made->file.empty()) {
          throw PreconditionError("step '" + input.from + "', which this one needs, has not ended");
        }
        input.file = made->file;
        input.digest = made->digest;
        input.content = made->content;
        input.entry = made->entry;
      }
      stamps_[input.file] = stamp_of(input.file);
      if (input.digest.empty() && fs::exists(input.file)) {  // a model: as it is now
        input.digest = input.content = digest_file(input.file);
      } else {
        require_digest(input);
      }
      if (input.entry) store_.touch(*input.entry);  // what is needed is not old to `strake gc`
    }
  }

  /// Refuses an input that has other bytes than it should.
  void require_digest(const OrderedInput& input) const {
    const bool exists = fs::exists(input.file);
    if (exists && digest_file(input.file) == input.digest) return;
    if (input.entry) store_.withdraw_if_damaged(*input.entry);
    const char* what = !exists ? "gone" : input.entry ? "damaged" : "changed";
    throw DamagedInput(fmt::format("'{}' is {}; {}", input.file.string(), what,
                                   input.entry ? "it will be made again" : "the run starts over"));
  }

  /// Refuses what was made from inputs that have changed since they were checked.
  void require_same_inputs() const {
    for (const auto* inputs : {&order_.inputs, &order_.parts}) {
      for (const OrderedInput& input : *inputs) {
        if (stamp_of(input.file) != stamps_.at(input.file)) require_digest(input);
      }
    }
  }

  /// The lock of the entry, once whoever makes it at present is done.
  std::unique_ptr<FolderLock> wait_for_lock(const EntryName& name) const {
    for (;;) {
      auto lock = std::make_unique<FolderLock>(store_.folder(name));
      if (lock->is_held()) return lock;
      show("waiting for another run that makes the same");
      if (interrupt_requested()) throw Interrupted();
      std::this_thread::sleep_for(kLockPause);
    }
  }

  /// Removes what a killed process left half written. Without locks somebody may still be writing
  /// it.
  void clean(const EntryName& name, const FolderLock& lock) const {
    if (!lock.is_exclusive()) return;
    std::error_code ignored;
    for (const auto& file : fs::directory_iterator(store_.folder(name), ignored)) {
      if (file.path().extension() == kTemporaryExtension) fs::remove(file.path(), ignored);
    }
  }

  /// Turns an event of the program into progress or a line of the log.
  void take_line(const std::string& line) {
    const Json event = Json::parse(line, nullptr, false);
    if (!event.is_object() || !event.contains("event")) {
      last_line_ = line;
      log(line);
    } else if (event["event"] == "progress") {
      const std::string phase = event.value("phase", "");
      show(fmt::format("{} {:.0f} %", phase, 100 * event.value("fraction", 0.0)));
      if (phase != phase_) log(phase);
      phase_ = phase;
    } else if (event["event"] == "error") {
      last_line_ = event.value("label", "") + ": error: " + event.value("message", line);
      log(last_line_);
    } else {
      const std::string text = event.value("text", line);
      if (text.starts_with(kWarning)) warnings_.push_back(text.substr(kWarning.size()));
      log(text);
    }
  }

  StepOutcome make() {
    show("checking inputs");
    resolve(order_.inputs);
    resolve(order_.parts);
    const Stage stage = make_stage(order_.stage);
    for (const Setting& setting : order_.settings) {
      stage.option(setting.option).parse_into(setting.value);
    }
    Provenance provenance = provenance_of(stage);
    for (const OrderedInput& input : order_.inputs) {
      provenance.inputs.push_back({input.port, input.content});
    }
    const EntryName name{order_.model, order_.stage,
                         key_of(provenance, fs::path(order_.file_name).extension().string())};
    const std::unique_ptr<FolderLock> lock = wait_for_lock(name);
    std::string damage;
    const std::optional<Entry> stored = store_.find(name, Store::Check::content, &damage);
    if (!damage.empty()) log("the store's artifact is not used: " + damage);
    if (stored && !order_.forced) {
      store_.touch(name);
      StepOutcome outcome;
      outcome.kind = StepOutcome::Kind::found;
      outcome.entry = name;
      outcome.file = stored->file;
      outcome.digest = stored->digest;
      outcome.content = stored->content;
      outcome.warnings = stored->warnings;
      log("found in the store: " + stored->file.string());
      return outcome;
    }
    return run_program(name, *lock, provenance, stored);
  }

  StepOutcome run_program(const EntryName& name, const FolderLock& lock,
                          const Provenance& provenance, const std::optional<Entry>& before) {
    std::optional<MemoryShare> share;
    if (settings_.memory > 0) {
      show("waiting for memory");
      share.emplace(folder_.path() / "memory", settings_.memory, order_.memory, [] {
        if (interrupt_requested()) throw Interrupted();
      });
    }
    clean(name, lock);
    Entry entry;
    entry.file = store_.folder(name) / order_.file_name;
    entry.provenance = provenance;
    std::vector<std::string> words = stage_command(order_, entry.file);
    words.insert(words.end(), {"--log-json", "--verbose"});  // the report belongs to the log
    log(fmt::format("{}", fmt::join(words, " ")));
    ChildProcess child(words);
    const ChildOutcome ended = child.wait([&](const std::string& line) { take_line(line); }, [] {});
    log(fmt::format("exit code {} after {:.3f} s, at most {} bytes of memory", ended.exit_code,
                    ended.seconds, ended.peak_bytes));
    if (ended.exit_code != 0) clean(name, lock);
    if (ended.exit_code == kCannotStart) {
      throw InputError(
          fmt::format("'{}' cannot be started: programs of stages belong beside "
                      "'strake'; install all of them there",
                      words.front()));
    }
    require_same_inputs();
    StepOutcome outcome;
    outcome.entry = name;
    outcome.seconds = ended.seconds;
    outcome.peak_bytes = ended.peak_bytes;
    outcome.exit_code = ended.exit_code;
    outcome.warnings = entry.warnings = warnings_;
    if (ended.exit_code != 0) {
      const bool spoke = !last_line_.empty() && ended.exit_code < kCannotStart;
      outcome.message = spoke ? last_line_ : fmt::format("'{}' {}", words.front(), ended.text());
      return outcome;
    }
    if (is_artifact(entry.file) && read_artifact_info(entry.file).provenance != provenance) {
      throw AlgorithmError(
          fmt::format("'{}' says it was made in another way than asked for; are "
                      "the programs beside 'strake' of its version?",
                      entry.file.string()));
    }
    entry.digest = digest_file(entry.file);
    entry.content = content_digest(entry.file);
    entry.seconds = ended.seconds;
    entry.peak_bytes = ended.peak_bytes;
    if (before && before->digest != entry.digest) {
      outcome.message = "warning: running again gave other bytes than before; please report this";
    }
    store_.add(name, entry);
    outcome.kind = StepOutcome::Kind::ran;
    outcome.file = entry.file;
    outcome.digest = entry.digest;
    outcome.content = entry.content;
    return outcome;
  }

  RunFolder folder_;
  StepOrder order_;
  RunSettings settings_;
  Store store_;
  std::ofstream log_;
  std::map<fs::path, std::optional<FileStamp>> stamps_;  ///< of the inputs, when they were checked
  std::string phase_;
  std::vector<std::string> warnings_;  ///< of the program
  std::string last_line_;              ///< of errors and plain text, as crashes leave it
};

}  // namespace

int execute_step(const fs::path& run_folder, const std::string& id, std::int64_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // an engine that is killed takes its steps with it
  if (parent != 0 && ::getppid() != parent) throw Interrupted();  // it died before the line above
  return StepRun(run_folder, id).run();
}

}  // namespace strake
