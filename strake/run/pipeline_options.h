#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "strake/run/description.h"
#include "strake/run/plan.h"

namespace CLI {
class App;
}

namespace strake {

/// What all commands about a pipeline share: its file, the store, targets and one-off settings.
struct PipelineOptions {
  std::string file = "pipeline.yaml";
  std::string store;
  std::string until;
  std::vector<std::string> settings;
  std::vector<std::string> targets;

  void add_to(CLI::App& app);
  /// The file and the store only: for commands about all of it.
  void add_file_to(CLI::App& app);
  /// Reads the file; the store is the one named here, if one is.
  [[nodiscard]] Description read() const;
  /// The folder of the option --store. \pre it was given \throw UsageError
  [[nodiscard]] std::filesystem::path named_store() const;
  [[nodiscard]] Selection selection(const Description& description) const;
};

/// \throw UsageError where there is no such rule
/// \param option  that named it;
/// \param name  "": none
void check_rule_name(const std::string& name, const Description& description,
                     const std::string& option);

}  // namespace strake
