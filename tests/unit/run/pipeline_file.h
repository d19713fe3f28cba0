#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "strake/run/description.h"

namespace strake::run_test {

/// A test with a folder of its own, in which two model files lie: a.obj and b.ply.
class PipelineFileTest : public testing::Test {
 protected:
  PipelineFileTest();
  ~PipelineFileTest() override;

  void put(const std::string& name, const std::string& text) const;
  /// Reads this text as a pipeline file.
  [[nodiscard]] Description describe(const std::string& text) const;
  /// What reading (and planning) it says against it, after the name of the file: "3:1: unknown ..."
  [[nodiscard]] std::string complaint(const std::string& text) const;

  std::filesystem::path folder_;
};

}  // namespace strake::run_test
