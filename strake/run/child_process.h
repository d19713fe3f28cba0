#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace strake {

/// Exit code of a program that could not be started, as shells have it.
inline constexpr int kCannotStart = 127;

/// How a program ended.
struct ChildOutcome {
  int exit_code = 0;  ///< 128 + signal where a signal ended it
  double seconds = 0;
  std::int64_t peak_bytes = 0;  ///< of memory

  /// "ended with exit code 3", "was killed by signal 9 (Killed)", "cannot be started".
  [[nodiscard]] std::string text() const;
};

/// A program run by this one. It ends with this process, even where this process is killed.
class ChildProcess {
 public:
  /// Starts the program with stdin closed, and stdout and stderr going to this object.
  /// \param arguments  the program, as a path or to be found in PATH, and its arguments
  /// \param folder     to run in; empty: the present one
  /// \throw InputError where it cannot be started
  explicit ChildProcess(const std::vector<std::string>& arguments,
                        const std::filesystem::path& folder = {});
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Kills it where it still runs.
  ~ChildProcess();

  /// Passes on what it prints, line by line, and calls `idle` some times a second, until it ends.
  /// An interruption of this process is passed on to it once.
  ChildOutcome wait(const std::function<void(const std::string&)>& on_line,
                    const std::function<void()>& idle);

 private:
  void read_lines(const std::function<void(const std::string&)>& on_line);

  pid_t process_ = -1;
  int output_ = -1;
  std::string unfinished_;  ///< beginning of a line
  bool at_end_ = false;
  double started_ = 0;
};

}  // namespace strake
