#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "strake/report/viewer.h"
#include "tests/support/needs.h"

/// A test needs the page that reports are filled into, which this build may lack.
#define STRAKE_VIEWER_OR_SKIP()                          \
  STRAKE_NEEDS(!::strake::report::viewer_page().empty(), \
               "the page of reports: scripts/build_viewer, and build again")

namespace strake::pipeline_test {

// Exit codes.
constexpr int kInternal = 1;
constexpr int kUsage = 2;
constexpr int kBadInput = 3;
constexpr int kPrecondition = 4;
constexpr int kAlgorithmFailed = 5;
constexpr int kInterrupted = 130;

/// What a program did.
struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// A folder of its own for each test, with the programs at hand.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  /// Runs a command line in the folder; its first word is a program of strake.
  Outcome run(const std::string& command_line);
  /// Runs any command line in the folder.
  Outcome shell(const std::string& command_line);
  /// Runs a command line that must succeed.
  std::string must(const std::string& command_line);
  /// Runs a command line that must fail with this code, leave no output, and say `part` on stderr.
  void must_fail(int exit_code, const std::string& command_line, const std::string& part);

  /// Runs import, tensor, smooth, trace and mesh on `input`, each output as PREFIXmesh.hdf and so
  /// on.
  void run_chain(const std::string& input, const std::string& prefix,
                 const std::string& flags = "");
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string bytes(const std::string& name) const;
  void put(const std::string& name, const std::string& text) const;

  std::filesystem::path folder_;
};

}  // namespace strake::pipeline_test
