#include "strake/run/survey.h"

#include <gtest/gtest.h>

#include <string>

#include "common/core/error.h"
#include "tests/unit/run/pipeline_file.h"

namespace strake {
namespace {

using DeliverTest = run_test::PipelineFileTest;

/// As by `strake gc` between the look at the store and the copy.
TEST_F(DeliverTest, AnArtifactThatHasGoneIsNamed) {
  const auto artifact = folder_ / "gone.hdf";
  try {
    deliver(artifact, folder_ / "new" / "out.hdf");
    FAIL() << "nothing was copied";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("'" + artifact.string() + "' has gone"), 0u)
        << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new"));
}

}  // namespace
}  // namespace strake
