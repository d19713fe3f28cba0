#include "strake/run/ninja_engine.h"

#include <fmt/format.h>

#include <deque>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "strake/run/child_process.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostLines = 20;

/// A word for the shell that runs it, within a line of Ninja's.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) {
    text += c == '\'' ? "'\\''" : c == '$' ? "$$" : std::string(1, c);
  }
  return text + "'";
}

std::string build_file(const RunFolder& folder, const std::vector<StepOrder>& orders) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  // exec: the step must be a child of Ninja's own, to end with it.
  std::string text =
      fmt::format("rule step\n  command = exec {} step {} $id --parent \"$$STRAKE_ENGINE\"\n",
                  quoted(program), quoted(folder.path().string()));
  const auto target = [](const std::string& id) { return "outcomes/" + id + ".json"; };
  for (const StepOrder& order : orders) {
    text += fmt::format("build {}: step |", target(order.id));
    for (const std::string& id : ids_before(order)) text += " " + target(id);
    text += fmt::format("\n  id = {}\n", order.id);
  }
  return text;
}

}  // namespace

std::string run_with_ninja(const RunFolder& folder, const std::vector<StepOrder>& orders,
                           std::int64_t jobs, const std::function<void()>& idle) {
  write_text(folder.ninja_file(), build_file(folder, orders), Flush::no);
  std::ofstream log(folder.path() / "logs" / "ninja.txt");
  const char* keep_going = folder.settings().keep_going ? "0" : "1";
  // The shell becomes Ninja and keeps its number, by which steps know whether it still lives.
  ChildProcess ninja({"sh", "-c", "STRAKE_ENGINE=$$ exec ninja \"$@\"", "sh", "-j",
                      std::to_string(jobs), "-k", keep_going},
                     folder.path());
  std::deque<std::string> last_lines;
  const auto take_line = [&](const std::string& line) {
    log << line << '\n';
    last_lines.push_back(line);
    if (last_lines.size() > kMostLines) last_lines.pop_front();
  };
  const ChildOutcome ended = ninja.wait(take_line, idle);
  if (ended.exit_code == kCannotStart) {
    throw InputError("'ninja' is needed to run a pipeline; apt-get install ninja-build");
  }
  if (ended.exit_code == 0) return "";
  return fmt::format("{}\nninja {}", fmt::join(last_lines, "\n"), ended.text());
}

}  // namespace strake
