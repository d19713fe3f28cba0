#include <CLI/App.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "strake/commands.h"
#include "strake/run/execute_step.h"

namespace strake {

void add_step_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("step", "Carry out one step of a run; engines call this.");
  const auto folder = std::make_shared<std::string>();
  const auto id = std::make_shared<std::string>();
  command->add_option("run", *folder, "folder of the run")->type_name("FOLDER")->required();
  command->add_option("id", *id, "step to carry out")->type_name("ID")->required();
  const auto parent = std::make_shared<std::int64_t>(0);
  command->add_option("--parent", *parent, "process to end with")->type_name("PID");
  command->callback([folder, id, parent, &chosen] {
    chosen = [folder, id, parent] { return execute_step(*folder, *id, *parent); };
  });
}

}  // namespace strake
