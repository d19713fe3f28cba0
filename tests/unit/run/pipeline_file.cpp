#include "tests/unit/run/pipeline_file.h"

#include <unistd.h>

#include <fstream>

#include "common/core/error.h"
#include "strake/run/plan.h"

namespace strake::run_test {

namespace fs = std::filesystem;

PipelineFileTest::PipelineFileTest()
    : folder_(fs::path(testing::TempDir()) / ("strake-run-" + std::to_string(::getpid()))) {
  fs::create_directories(folder_);
  put("a.obj", "v 0 0 0\n");
  put("b.ply", "ply\n");
}

PipelineFileTest::~PipelineFileTest() { fs::remove_all(folder_); }

void PipelineFileTest::put(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

Description PipelineFileTest::describe(const std::string& text) const {
  put("pipeline.yaml", text);
  return read_description(folder_ / "pipeline.yaml");
}

std::string PipelineFileTest::complaint(const std::string& text) const {
  try {
    make_plan(describe(text), {});
  } catch (const UsageError& error) {
    const std::string message = error.what();
    const std::string file = (folder_ / "pipeline.yaml").string() + ":";
    EXPECT_EQ(message.rfind(file, 0), 0u) << message;
    return message.substr(file.size());
  }
  ADD_FAILURE() << "was accepted:\n" << text;
  return "";
}

}  // namespace strake::run_test
