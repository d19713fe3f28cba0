#include "tests/pipeline/pipeline_run.h"

namespace strake::pipeline_test {
namespace {

using ReportOfPipeline = PipelineTest;

TEST_F(ReportOfPipeline, ShowsWhatTheStoreHoldsWithTheTimesOfItsSteps) {
  pipeline(
      "models: {torus: {sample: {kind: torus, faces: 1000}}}\n"
      "variants: {eps: {trace: {tolerance: [1%, 2%]}}}\n");
  must_fail(4, "strake report --pipeline pipeline.yaml -o report.html", "strake run");
  must("strake run -q");
  must_fail(2, "strake report --pipeline pipeline.yaml moon -o report.html", "moon");
  must_fail(2, "strake report -o report.html", "--pipeline");
  STRAKE_VIEWER_OR_SKIP();
  must("strake report --pipeline pipeline.yaml -o report.html");
  const std::string page = bytes("report.html");
  for (const std::string text :
       {"\"name\":\"torus/eps-1\"", "\"name\":\"torus/eps-2\"", "\"trace\":", "\"missing\":[]"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(page.find("\"seconds\":null"), std::string::npos);
  must("strake report --pipeline pipeline.yaml torus/eps-2 -o one.html");
  EXPECT_EQ(bytes("one.html").find("\"name\":\"torus/eps-1\""), std::string::npos);
}

}  // namespace
}  // namespace strake::pipeline_test
