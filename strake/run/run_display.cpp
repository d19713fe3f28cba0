#include "strake/run/run_display.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "common/stage/console.h"
#include "strake/run/resources.h"

namespace strake {
namespace {

constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::seconds kLine{10};

std::string outcome_text(const StepOutcome& outcome) {
  switch (outcome.kind) {
    case StepOutcome::Kind::ran:
      return "ran";
    case StepOutcome::Kind::found:
      return "found";
    case StepOutcome::Kind::damaged:
      return "input damaged";
    case StepOutcome::Kind::failed:
      break;
  }
  return outcome.is_interrupted() ? "interrupted" : fmt::format("failed ({})", outcome.exit_code);
}

}  // namespace

RunDisplay::RunDisplay(const RunFolder& folder, const std::vector<StepOrder>& orders, bool quiet)
    : folder_(folder),
      orders_(orders),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      last_shown_(std::chrono::steady_clock::now()) {}

void RunDisplay::update() {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_shown_ < kRedraw) return;
  show_ended(Stopped::may_go_on);
  if (!terminal_ && now - last_shown_ < kLine) return;
  last_shown_ = now;
  show_running();
}

void RunDisplay::finish() {
  clear_block();
  show_ended(Stopped::have_ended);
}

void RunDisplay::show_ended(Stopped steps) {
  for (const StepOrder& order : orders_) {
    if (ended_.count(order.id) != 0) continue;
    const std::optional<StepOutcome> outcome = folder_.outcome(order.id);
    if (!outcome) continue;
    if (outcome->is_interrupted() && steps == Stopped::may_go_on) continue;
    ended_.insert(order.id);
    if (quiet_ && outcome->exit_code == 0) continue;
    clear_block();
    fmt::print(
        stderr, "[{}/{}] {}: {}{}\n", ended_.size(), orders_.size(), order.title,
        outcome_text(*outcome),
        outcome->kind == StepOutcome::Kind::ran ? ", " + seconds_text(outcome->seconds) : "");
    for (const std::string& warning : outcome->warnings) {
      write_stderr(fmt::format("    warning: {}\n", warning));
    }
    if (!outcome->message.empty()) {
      write_stderr(fmt::format("    {}\n    log: {}\n", outcome->message,
                               folder_.log_file(order.id).string()));
    }
  }
}

void RunDisplay::show_running() {
  clear_block();
  for (const RunFolder::Running& running : folder_.running()) {
    const auto order = std::find_if(orders_.begin(), orders_.end(),
                                    [&](const StepOrder& other) { return other.id == running.id; });
    if (order == orders_.end() || ended_.count(running.id) != 0) continue;
    write_stderr(fmt::format("  {}: {}\n", order->title, running.text));
    if (terminal_) ++block_lines_;
  }
  std::fflush(stderr);
}

void RunDisplay::clear_block() {
  for (; block_lines_ > 0; --block_lines_) write_stderr("\033[A\033[2K");
}

std::string run_table(const RunFolder& folder, const std::vector<StepOrder>& orders) {
  std::size_t width = 4;
  for (const StepOrder& order : orders) width = std::max(width, order.title.size());
  std::string text =
      fmt::format("{:{}}  {:13}  {:>8}  {:>8}\n", "step", width, "outcome", "time", "memory");
  for (const StepOrder& order : orders) {
    const std::optional<StepOutcome> outcome = folder.outcome(order.id);
    const bool ran = outcome && outcome->seconds > 0;
    text += fmt::format("{:{}}  {:13}  {:>8}  {:>8}\n", order.title, width,
                        outcome ? outcome_text(*outcome) : "not run",
                        ran ? seconds_text(outcome->seconds) : "-",
                        ran ? bytes_text(static_cast<double>(outcome->peak_bytes)) : "-");
  }
  return text;
}

}  // namespace strake
