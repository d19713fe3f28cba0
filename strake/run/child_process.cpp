#include "strake/run/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "common/core/error.h"
#include "common/stage/console.h"

namespace strake {
namespace {

constexpr int kPollMilliseconds = 100;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Signals that ask to end wait while it lives. Between fork and exec a handler of the parent's
/// would swallow them.
class HeldSignals {
 public:
  HeldSignals() {
    sigset_t asking;
    ::sigemptyset(&asking);
    for (const int number : kAsking) ::sigaddset(&asking, number);
    ::pthread_sigmask(SIG_BLOCK, &asking, &before_);
  }
  ~HeldSignals() { release(); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  /// In the new process: they end it from here on.
  void release_as_child() const {
    for (const int number : kAsking) ::signal(number, SIG_DFL);
    release();
  }

 private:
  static constexpr std::array kAsking{SIGINT, SIGTERM};

  void release() const { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  sigset_t before_{};
};

/// What runs in the new process: only calls that are safe between fork and exec.
[[noreturn]] void become(char* const* arguments, const char* folder, int output, pid_t parent,
                         const HeldSignals& held) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  held.release_as_child();
  if (::getppid() != parent) ::_exit(kCannotStart);  // it died before the line above
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  if (folder[0] != '\0' && ::chdir(folder) != 0) ::_exit(kCannotStart);
  ::execvp(arguments[0], arguments);
  ::_exit(kCannotStart);
}

}  // namespace

std::string ChildOutcome::text() const {
  constexpr int kSignalBase = 128;
  constexpr int kMostSignals = 64;
  if (exit_code == kCannotStart) return "cannot be started";
  if (exit_code <= kSignalBase || exit_code > kSignalBase + kMostSignals) {
    return fmt::format("ended with exit code {}", exit_code);
  }
  const int signal = exit_code - kSignalBase;
  return fmt::format("was killed by signal {} ({}){}", signal, ::strsignal(signal),
                     signal == SIGKILL ? "; is the memory too small?" : "");
}

ChildProcess::ChildProcess(const std::vector<std::string>& arguments,
                           const std::filesystem::path& folder)
    : started_(now()) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments)
    pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  std::array<int, 2> pipe_ends{};
  if (::pipe2(pipe_ends.data(), O_CLOEXEC) != 0) {
    throw InputError(fmt::format("cannot start '{}': {}", arguments[0], std::strerror(errno)));
  }
  const pid_t parent = ::getpid();
  const HeldSignals held;
  process_ = ::fork();
  if (process_ == 0) become(pointers.data(), folder.c_str(), pipe_ends[1], parent, held);
  const int error = errno;
  ::close(pipe_ends[1]);
  output_ = pipe_ends[0];
  if (process_ < 0) {
    ::close(output_);
    throw InputError(fmt::format("cannot start '{}': {}", arguments[0], std::strerror(error)));
  }
}

ChildProcess::~ChildProcess() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(output_);
}

void ChildProcess::read_lines(const std::function<void(const std::string&)>& on_line) {
  std::array<char, 4096> block{};
  const ssize_t count = ::read(output_, block.data(), block.size());
  if (count < 0 && errno == EINTR) return;
  at_end_ = count <= 0;
  for (ssize_t i = 0; i < count; ++i) {
    if (block[static_cast<std::size_t>(i)] != '\n') {
      unfinished_ += block[static_cast<std::size_t>(i)];
      continue;
    }
    on_line(unfinished_);
    unfinished_.clear();
  }
  if (at_end_ && !unfinished_.empty()) on_line(unfinished_);
}

ChildOutcome ChildProcess::wait(const std::function<void(const std::string&)>& on_line,
                                const std::function<void()>& idle) {
  bool passed_on = false;
  int status = 0;
  rusage usage = {};
  while (process_ > 0) {
    pollfd waiting = {output_, POLLIN, 0};
    if (at_end_) {
      ::poll(nullptr, 0, kPollMilliseconds / 10);
    } else if (::poll(&waiting, 1, kPollMilliseconds) > 0) {
      read_lines(on_line);
    }
    if (interrupt_requested() && !passed_on) {
      passed_on = true;
      ::kill(process_, SIGINT);
    }
    idle();
    // Its output ends before it does, unless somebody it started keeps the pipe open.
    if (::wait4(process_, &status, WNOHANG, &usage) == process_) process_ = -1;
  }
  while (!at_end_) {
    pollfd rest = {output_, POLLIN, 0};
    if (::poll(&rest, 1, 0) <= 0) break;
    read_lines(on_line);
  }
  ChildOutcome outcome;
  outcome.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  outcome.seconds = now() - started_;
  outcome.peak_bytes = std::int64_t{usage.ru_maxrss} * 1024;
  return outcome;
}

}  // namespace strake
