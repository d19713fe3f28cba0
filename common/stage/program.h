#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/stage/console.h"
#include "common/stage/report_text.h"
#include "common/stage/stage.h"

namespace CLI {
class App;  // including it costs every file some seconds
}

/// What every program of strake shares: command line, threads, signals, errors, exit codes.
namespace strake {

/// Adds a flag or option per declared option, with unit, range and default in its help.
/// \param target  an App or one of its option groups
void add_options(CLI::App& target, const OptionList& options);

/// The options that every program has.
struct ShellOptions {
  std::int64_t threads = 0;  ///< 0: all processors
  bool quiet = false;
  bool verbose = false;
  bool log_json = false;
  std::string report_path;
  std::string repro;  ///< folder for what a failure takes to repeat; "": nothing is kept

  /// Adds --threads, --quiet, --verbose, --log-json, --report and --repro.
  void add_to(CLI::App& app);
  [[nodiscard]] LogFormat log_format() const {
    return log_json ? LogFormat::json : LogFormat::text;
  }
  /// What the running work reports to.
  [[nodiscard]] ConsoleObserver console() const;
};

/// A file that a program reads or writes, and what it is to the user: "input", "report".
struct NamedFile {
  std::string role;
  std::string path;  ///< "": none
};

/// Whether two paths name one file: of files that are there by what they are, of others by where
/// they would be.
bool is_same_file(const std::string& a, const std::string& b);

/// Refuses, before any work is done, files to write that are files to read, or each other; and a
/// report that could not be written.
/// \throw UsageError, InputError naming the file and a remedy
void check_files(const std::vector<NamedFile>& read, const std::string& output,
                 const std::string& report);

/// The form in which a command line wants errors, its own faults among them: --log-json or text.
LogFormat wanted_log_format(int argc, char** argv);

/// Runs `body` with signals caught and with every error turned into a message and an exit code;
/// that what it printed cannot be written is one.
/// \return what `body` returns, or the error's exit code
int run_guarded(const std::string& program, LogFormat errors, const std::function<int()>& body);

/// Parses the command line. Where it is `--generate man`, or a shell instead of "man", prints
/// manual page or completion script of the program, for packages.
/// \return the exit code where the program has answered (help, version)
/// \throw UsageError where the command line is wrong, with what was probably meant
std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv);

/// Runs `work` with the wanted number of threads. \param threads  0: all processors
void run_with_threads(std::int64_t threads, const std::function<void()>& work);

/// The whole program of a stage: reads its inputs, runs it, writes output and report.
int stage_main(const Stage& stage, int argc, char** argv);

}  // namespace strake
