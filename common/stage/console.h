#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "common/core/error.h"
#include "common/core/stage_observer.h"

namespace strake {

/// How much a program says on stderr.
enum class Verbosity { quiet, normal, verbose };

/// How events are written to stderr: for people, or one JSON object per line for programs.
enum class LogFormat { text, json };

/// Takes the numbers of standard streams that are closed, so that no file that is opened later gets
/// one, and messages with it. Writing to them fails as before.
void open_missing_streams();

/// Writes to stderr. Where that fails, as on a full disk or a closed stream, the text is lost, and
/// nothing else: a run goes on without anybody listening.
void write_stderr(std::string_view text);

/// From now on SIGINT and SIGTERM ask the running stage to stop; a second one ends the program. A
/// limit of file sizes is an error like a full disk, and ends nothing.
void catch_interrupts();

/// From now on the process is ended half a second after such a signal, if it has not ended by then:
/// algorithms look for signals only where they have a moment; at once after a second one. Files
/// that are not written whole are removed. For programs that have started no other processes.
/// \param format  of the error that says so
void end_soon_after_interrupts(const std::string& program, LogFormat format);

/// Whether one of these signals has arrived.
bool interrupt_requested();

/// Whether messages on stderr may have colours: on a terminal that is not dumb, unless NO_COLOR is
/// set to something (https://no-color.org).
bool use_colours();

/// The text with a word such as "error:" or "warning:" in colour, where colours may be used.
std::string highlighted(const std::string& text);

/// Says on stderr why a program ends; as JSON {"event": "error", "label", "code", "message"}.
void say_error(const std::string& program, const std::string& message, ExitCode code,
               LogFormat format);

/// Shows progress on stderr: a bar on a terminal, with pace and time left after a
/// second; a line per phase otherwise. As JSON:
/// {"event": "progress", "label", "phase", "fraction"} and {"event": "message", "text"}.
/// Cancels the run with Interrupted once a caught signal has arrived.
class ConsoleObserver : public StageObserver {
 public:
  explicit ConsoleObserver(Verbosity verbosity, LogFormat format = LogFormat::text);
  ConsoleObserver(const ConsoleObserver&) = delete;
  ConsoleObserver& operator=(const ConsoleObserver&) = delete;
  ~ConsoleObserver() override;

  /// What the next phases belong to: the name of a stage.
  void begin(const std::string& label) override;
  void report(std::string_view phase, double fraction) override;
  /// A line for the user, above the bar; nothing if quiet.
  void say(const std::string& line) override;

 private:
  void clear_bar();
  void show_progress(double share, bool new_phase);

  Verbosity verbosity_;
  LogFormat format_;
  bool terminal_;
  bool bar_visible_ = false;
  std::string label_;
  std::string phase_;
  std::chrono::steady_clock::time_point phase_began_{};
  std::chrono::steady_clock::time_point last_shown_{};
};

}  // namespace strake
