#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/artifact/store/store.h"
#include "common/core/error.h"
#include "strake/run/plan.h"
#include "strake/run/survey.h"

/// The folder in which one run is written down, so that any process on any machine that sees it can
/// carry out a step: engines only decide when and where.
namespace strake {

/// An artifact that a step works on.
struct OrderedInput {
  std::string port;
  std::string from;                ///< id of the step that makes it; "" where it is there already
  std::filesystem::path file;      ///< otherwise
  std::string digest;              ///< of its bytes
  std::string content;             ///< `content_digest`
  std::optional<EntryName> entry;  ///< where the file belongs to the store
};

/// All that a process has to know to carry out one step.
struct StepOrder {
  std::string id;
  std::string title;
  std::string model;
  std::size_t model_index = 0;  ///< its place in the pipeline file
  std::string rule;
  std::string stage;    ///< whose result it is; part of the key
  std::string program;  ///< that makes it
  std::vector<Setting> settings;
  std::vector<OrderedInput> inputs;
  std::vector<OrderedInput> parts;
  std::string file_name;
  std::vector<std::string> deliver_to;
  std::int64_t memory = 0;  ///< bytes it is expected to take
  double seconds = 0;       ///< it is expected to take
  std::int64_t threads = 0;
  bool forced = false;  ///< run even where the result is in the store
};

/// What became of a step.
struct StepOutcome {
  enum class Kind {
    ran,
    found,  ///< the result turned out to be in the store
    failed,
    damaged,  ///< an input turned out to be damaged; it was withdrawn from the store
  };
  Kind kind = Kind::failed;
  std::string message;                ///< why it failed
  std::vector<std::string> warnings;  ///< that the program had for the user, also when it was found
  int exit_code = 0;
  EntryName entry;
  std::filesystem::path file;
  std::string digest;   ///< of the file's bytes
  std::string content;  ///< `content_digest` of the file
  double seconds = 0;
  std::int64_t peak_bytes = 0;

  /// Whether it was told to stop. A cluster starts such a step once more where it took the machine
  /// for another job.
  [[nodiscard]] bool is_interrupted() const {
    return kind == Kind::failed && exit_code == static_cast<int>(ExitCode::interrupted);
  }
};

/// What holds for all steps of a run.
struct RunSettings {
  std::filesystem::path store;
  std::int64_t memory = 0;  ///< bytes for all steps at once; 0: no limit (a cluster sees to it)
  bool keep_going = false;
  std::filesystem::path pipeline;    ///< the file
  std::vector<std::string> targets;  ///< that were asked for; empty: everything
  std::string until;                 ///< last stage; empty: all
  std::vector<std::string> options;  ///< "STAGE.OPTION=VALUE", for this time only
};

class RunFolder {
 public:
  /// Opens a folder that `create` made.
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}

  /// Makes a new folder in the store and writes down the settings.
  /// \throw InputError
  static RunFolder create(const Store& store, const RunSettings& settings);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] RunSettings settings() const;

  void write_order(const StepOrder& order) const;
  [[nodiscard]] StepOrder order(const std::string& id) const;
  void write_outcome(const std::string& id, const StepOutcome& outcome) const;
  /// Nothing where the step has not ended.
  [[nodiscard]] std::optional<StepOutcome> outcome(const std::string& id) const;

  /// Whether Ninja carries it out: by processes that end with the one that holds the lock.
  [[nodiscard]] bool is_local() const;
  /// Whether every step that was ordered has.
  [[nodiscard]] bool has_ended() const;

  [[nodiscard]] std::filesystem::path ninja_file() const { return path_ / "build.ninja"; }
  [[nodiscard]] std::filesystem::path outcome_file(const std::string& id) const;
  [[nodiscard]] std::filesystem::path log_file(const std::string& id) const;
  /// Holds what a running step is at: one line for people.
  [[nodiscard]] std::filesystem::path progress_file(const std::string& id) const;
  /// Steps that wrote progress and have not ended, with what they are at.
  struct Running {
    std::string id;
    std::string text;
  };
  [[nodiscard]] std::vector<Running> running() const;

 private:
  std::filesystem::path path_;
};

/// The orders of all steps that are stale, in the order of the plan.
/// \param threads  for steps that do not say
std::vector<StepOrder> stale_orders(const Plan& plan, const std::vector<StepState>& states,
                                    std::int64_t threads);

/// Ids of the steps that must have ended before this one.
std::vector<std::string> ids_before(const StepOrder& order);

}  // namespace strake
