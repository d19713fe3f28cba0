#include "common/stage/console.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>
#include <utility>

#include "common/artifact/atomic_file.h"
#include "common/stage/pace.h"

namespace strake {
namespace {

volatile sig_atomic_t interrupt_arrived = 0;

/// Where handlers of signals tell a thread that waits for one; -1: there is none.
volatile sig_atomic_t interrupt_pipe = -1;

void on_interrupt(int /*signal*/) {
  interrupt_arrived = 1;
  if (interrupt_pipe < 0) return;
  const int error = errno;
  [[maybe_unused]] const ssize_t written = ::write(interrupt_pipe, "", 1);
  errno = error;
}

constexpr std::chrono::milliseconds kPatience{500};
/// Bytes of memory up to which a run keeps what it has: taking it in anew takes small ones longer
/// than their stages do.
constexpr std::size_t kSmallRun = std::size_t{64} << 20;

[[noreturn]] void end_after_interrupt(int pipe, const std::string& program, LogFormat format) {
  char byte = 0;
  while (::read(pipe, &byte, 1) != 1) {
  }
  struct pollfd next = {pipe, POLLIN, 0};  // who asks twice does not want to wait
  ::poll(&next, 1, static_cast<int>(kPatience.count()));
  AtomicFile::abandon_all();
  const Interrupted reason;
  say_error(program, reason.what(), reason.code(), format);
  ::_exit(static_cast<int>(reason.code()));
}

/// \param flags  of sigaction
void handle_interrupts(int flags) {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = flags;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void print_event(const nlohmann::ordered_json& event) {
  constexpr bool kAsciiOnly = true;
  using Handler = nlohmann::ordered_json::error_handler_t;
  write_stderr(event.dump(-1, ' ', kAsciiOnly, Handler::replace) + "\n");
}

}  // namespace

void open_missing_streams() {
  for (int number = 0; number < 3; ++number) {
    if (::fcntl(number, F_GETFD) < 0) static_cast<void>(::open("/dev/null", O_RDONLY));
  }
}

void write_stderr(std::string_view text) {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
}

void catch_interrupts() {
  handle_interrupts(static_cast<int>(SA_RESETHAND | SA_RESTART));
  // A file that may not grow any more is an error of whoever writes it, as on a full disk.
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &ignore, nullptr);
}

void end_soon_after_interrupts(const std::string& program, LogFormat format) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;  // it ends when the algorithm looks
  try {
    std::thread(end_after_interrupt, ends[0], program, format).detach();
    interrupt_pipe = ends[1];
    handle_interrupts(SA_RESTART);      // also of a second one: the thread leaves no file behind
  } catch (const std::system_error&) {  // no room for its stack: likewise
    ::close(ends[0]);
    ::close(ends[1]);
  }
}

bool interrupt_requested() { return interrupt_arrived != 0; }

bool use_colours() {
  const char* refused = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  if (refused != nullptr && *refused != '\0') return false;
  if (terminal == nullptr || std::string_view(terminal) == "dumb") return false;
  return isatty(STDERR_FILENO) != 0;
}

std::string highlighted(const std::string& text) {
  if (!use_colours()) return text;
  constexpr std::pair<std::string_view, std::string_view> kColours[] = {
      {"error: ", "\033[1;31m"}, {"warning: ", "\033[1;33m"}};
  for (const auto& [word, colour] : kColours) {
    const std::size_t place = text.find(word);
    if (place == std::string::npos) continue;
    constexpr const char* kPlain = "\033[0m";
    return fmt::format("{}{}{}{}{}", text.substr(0, place), colour, word, kPlain,
                       text.substr(place + word.size()));
  }
  return text;
}

void say_error(const std::string& program, const std::string& message, ExitCode code,
               LogFormat format) {
  if (format == LogFormat::json) {
    print_event({{"event", "error"},
                 {"label", program},
                 {"code", static_cast<int>(code)},
                 {"message", message}});
  } else {
    write_stderr(highlighted(program + ": error: " + message) + "\n");
  }
}

ConsoleObserver::ConsoleObserver(Verbosity verbosity, LogFormat format)
    : verbosity_(verbosity),
      format_(format),
      terminal_(format == LogFormat::text && isatty(STDERR_FILENO) != 0) {}

ConsoleObserver::~ConsoleObserver() { clear_bar(); }

void ConsoleObserver::begin(const std::string& label) {
  // What the last one has freed makes room for this one.
  const struct mallinfo2 memory = mallinfo2();
  if (memory.arena + memory.hblkhd > kSmallRun) malloc_trim(0);
  clear_bar();
  label_ = label;
  phase_.clear();
}

void ConsoleObserver::report(std::string_view phase, double fraction) {
  if (interrupt_requested()) throw Interrupted();
  if (verbosity_ == Verbosity::quiet) return;
  using namespace std::chrono_literals;
  const auto now = std::chrono::steady_clock::now();
  const bool new_phase = phase != phase_;
  const auto pause = terminal_ || format_ == LogFormat::json ? 100ms : 10s;
  if (!new_phase && now - last_shown_ < pause) return;
  if (new_phase) phase_began_ = now;
  phase_ = phase;
  last_shown_ = now;
  show_progress(std::clamp(fraction, 0.0, 1.0), new_phase);
  std::fflush(stderr);
}

void ConsoleObserver::show_progress(double share, bool new_phase) {
  if (format_ == LogFormat::json) {
    print_event({{"event", "progress"}, {"label", label_}, {"phase", phase_}, {"fraction", share}});
  } else if (terminal_) {
    constexpr int kWidth = 30;
    const int full = static_cast<int>(share * kWidth);
    const std::chrono::duration<double> elapsed = last_shown_ - phase_began_;
    const std::string pace = pace_text(elapsed.count(), share);
    write_stderr(fmt::format("\r\033[K{:9} [{:=<{}}{:{}}] {:3.0f} % {}{}{}", label_, "", full, "",
                             kWidth - full, 100 * share, phase_, pace.empty() ? "" : ", ", pace));
    bar_visible_ = true;
  } else if (new_phase) {
    write_stderr(fmt::format("{}: {}\n", label_, phase_));
  } else {
    write_stderr(fmt::format("{}: {} {:.0f} %\n", label_, phase_, 100 * share));
  }
}

void ConsoleObserver::say(const std::string& line) {
  if (verbosity_ == Verbosity::quiet) return;
  if (format_ == LogFormat::json) {
    print_event({{"event", "message"}, {"text", line}});
    return;
  }
  clear_bar();
  write_stderr(highlighted(line) + "\n");
}

void ConsoleObserver::clear_bar() {
  if (!bar_visible_) return;
  write_stderr("\r\033[K");
  std::fflush(stderr);
  bar_visible_ = false;
}

}  // namespace strake
