#include "strake/run/ninja_engine.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "strake/run/child_process.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr int kNotFound = 127;

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
  std::string text = fmt::format("rule step\n  command = exec {} step {} $id\n", quoted(program),
                                 quoted(folder.path().string()));
  const auto target = [](const std::string& id) { return "outcomes/" + id + ".json"; };
  for (const StepOrder& order : orders) {
    text += fmt::format("build {}: step |", target(order.id));
    for (const std::string& id : ids_before(order)) text += " " + target(id);
    text += fmt::format("\n  id = {}\n", order.id);
  }
  return text;
}

}  // namespace

void run_with_ninja(const RunFolder& folder, const std::vector<StepOrder>& orders,
                    std::int64_t jobs, const std::function<void()>& idle) {
  write_text(folder.path() / "build.ninja", build_file(folder, orders));
  std::ofstream log(folder.path() / "logs" / "ninja.txt");
  const char* keep_going = folder.settings().keep_going ? "0" : "1";
  ChildProcess ninja({"ninja", "-j", std::to_string(jobs), "-k", keep_going}, folder.path());
  const ChildOutcome ended =
      ninja.wait([&](const std::string& line) { log << line << '\n'; }, idle);
  if (ended.exit_code == kNotFound) {
    throw InputError("'ninja' is needed to run a pipeline; apt-get install ninja-build");
  }
}

}  // namespace strake
