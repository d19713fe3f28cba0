#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/pipeline/pipeline_run.h"

namespace strake::pipeline_test {
namespace {

namespace fs = std::filesystem;

/// Runs on a file system that has no locks, as some that machines share.
class NoLocks : public PipelineTest {
 protected:
  NoLocks() { pipeline("models: {torus: {sample: {kind: torus, faces: 2000}}}\n"); }

  /// A run that is cut off where it waits for what never comes.
  Outcome run_without_locks(const std::string& arguments) {
    return shell("LD_PRELOAD=" STRAKE_NO_LOCKS " timeout 60 " STRAKE_BIN "/strake run " +
                 arguments);
  }
};

TEST_F(NoLocks, NobodyWaitsForThem) {
  const Outcome outcome = run_without_locks("-q");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(must("strake run"), "0 steps run, 7 in the store\n");
}

/// Somebody else may be at the same entry.
TEST_F(NoLocks, WhatOthersAreWritingStays) {
  must("strake run -q --until tensor");
  const fs::path entry = artifact("torus/tensor-", "tensor.hdf").parent_path();
  const std::string half = (entry / ".tensor.hdf.1-0.tmp").lexically_relative(folder_).string();
  const auto begin_again = [&] {
    fs::remove(entry / "manifest.json");
    put(half, "half written");
  };
  begin_again();
  const Outcome outcome = run_without_locks("-q --until tensor");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(bytes(half), "half written");
  begin_again();
  must("strake run -q --until tensor");
  EXPECT_FALSE(fs::exists(file(half))) << "a killed process left it";
}

}  // namespace
}  // namespace strake::pipeline_test
