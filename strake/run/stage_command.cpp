#include "strake/run/stage_command.h"

#include <algorithm>
#include <variant>

#include "strake/run/stage_catalog.h"

namespace strake {

namespace fs = std::filesystem;

fs::path program_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

std::vector<std::string> stage_command(const StepOrder& order, const fs::path& output) {
  std::vector<std::string> words = {(program_folder() / ("strake-" + order.program)).string()};
  const Stage stage = make_stage(order.stage);
  for (const OrderedInput& input : order.inputs) {
    const auto port = std::find_if(stage.inputs.begin(), stage.inputs.end(),
                                   [&](const Port& p) { return p.name == input.port; });
    if (!port->required) words.push_back("--" + input.port);
    words.push_back(input.file.string());
  }
  for (const OrderedInput& part : order.parts) words.push_back(part.file.string());
  words.insert(words.end(), {"-o", output.string(), "--threads", std::to_string(order.threads)});
  if (!order.parts.empty()) return words;  // a merge takes its options from the parts
  for (const Setting& setting : order.settings) {
    stage.option(setting.option).parse_into(setting.value);
  }
  for (const auto& option : provenance_of(stage).options) {
    const bool is_flag = std::holds_alternative<bool*>(stage.option(option.name).target);
    if (option.is_default) continue;
    words.push_back("--" + option.name);
    if (!is_flag) words.push_back(option.value);
  }
  return words;
}

}  // namespace strake
