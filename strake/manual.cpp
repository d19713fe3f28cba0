#include <CLI/App.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "common/stage/command_tree.h"
#include "strake/commands.h"

namespace strake {

void add_manual_commands(CLI::App& app, Action& chosen) {
  CLI::App* man = app.add_subcommand("man", "Print the manual page: strake man | man -l -");
  man->footer("Example:\n  strake man | man -l -");
  man->callback([&app, &chosen] {
    chosen = [&app] {
      std::fputs(man_page(command_tree(app), STRAKE_VERSION).c_str(), stdout);
      return 0;
    };
  });
  CLI::App* completion = app.add_subcommand(
      "completion",
      "Print a script that completes command lines: source <(strake completion bash)");
  completion->footer("Examples:\n  strake completion bash\n  source <(strake completion bash)");
  const auto shell = std::make_shared<std::string>();
  completion->add_option("shell", *shell, "the shell to print it for")
      ->type_name("bash|zsh|fish")
      ->required();
  completion->callback([&app, &chosen, shell] {
    chosen = [&app, shell] {
      std::fputs(completion_script(command_tree(app), *shell).c_str(), stdout);
      return 0;
    };
  });
}

}  // namespace strake
