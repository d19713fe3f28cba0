#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/pipeline/run_program.h"

namespace strake::pipeline_test {

/// A folder with a pipeline file and its store in `store`, and what to ask about them.
class PipelineTest : public ProgramTest {
 protected:
  /// Writes pipeline.yaml: the version, the store, the stages import, tensor, smooth, trace, mesh
  /// and evaluate, and `text`.
  void pipeline(const std::string& text) const;
  /// `strake run` with these arguments; must succeed. What became of each step that was run:
  /// "torus trace" -> "ran", "found".
  std::map<std::string, std::string> run_steps(const std::string& arguments = "");
  /// The same from the table that a run printed, whatever its exit code.
  static std::map<std::string, std::string> steps_in(const std::string& table);
  /// Names of the steps with this outcome, in alphabetical order, separated by ", ".
  static std::string names(const std::map<std::string, std::string>& steps,
                           const std::string& outcome);

  /// The only file in the store whose path begins with `entry`, e.g. "torus/trace-", of this name.
  [[nodiscard]] std::filesystem::path artifact(const std::string& entry,
                                               const std::string& name) const;
  /// All entries: "torus/trace-0123456789abcdef".
  [[nodiscard]] std::vector<std::string> entries() const;
  /// Files below the folder with their bytes and times of change; of `part` of it only.
  [[nodiscard]] std::map<std::string, std::string> snapshot(const std::string& part = "") const;
};

/// Flips one bit in the middle of a file, in place.
void flip_bit(const std::filesystem::path& path);

}  // namespace strake::pipeline_test
