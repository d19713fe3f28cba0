#include <fstream>
#include <sstream>

#include "tests/pipeline/pipeline_run.h"

namespace strake::pipeline_test {
namespace {

/// Two models of one mesh; one of them has files beside it.
class SideInputs : public PipelineTest {
 protected:
  SideInputs() {
    must("strake sample plane -o plane.ply --faces 800");
    put("guides.obj", "v -0.5 -0.3 0\nv 0.5 0.3 0\nl 1 2\n");
    pipeline("models: {bare: plane.ply, drawn: {file: plane.ply, inputs: {guides: guides.obj}}}\n");
  }
  [[nodiscard]] std::string info(const std::string& entry, const std::string& name) {
    return must("strake info " + artifact(entry, name).string());
  }
};

TEST_F(SideInputs, GoIntoTheStagesOfTheirModel) {
  must("strake run -q");
  EXPECT_NE(info("drawn/smooth-", "field.hdf").find("from guides"), std::string::npos);
  EXPECT_EQ(info("bare/smooth-", "field.hdf").find("from guides"), std::string::npos);
  // As the program makes it by hand.
  const std::string mesh = artifact("drawn/import-", "mesh.hdf").string();
  const std::string tensor = artifact("drawn/tensor-", "tensor.hdf").string();
  must("strake-smooth " + mesh + " " + tensor + " --guides guides.obj -o field.hdf -q");
  const std::ifstream made(artifact("drawn/smooth-", "field.hdf"), std::ios::binary);
  std::ostringstream stored;
  stored << made.rdbuf();
  EXPECT_EQ(stored.str(), bytes("field.hdf"));
}

TEST_F(SideInputs, MakeStaleWhatDependsOnThem) {
  must("strake run -q");
  put("guides.obj", "v -0.5 -0.3 0\nv 0.5 0.4 0\nl 1 2\n");
  const std::string said = must("strake run -n --explain");
  EXPECT_NE(said.find("run    drawn smooth: other content of its input 'guides'"),
            std::string::npos)
      << said;
  EXPECT_EQ(names(run_steps(), "ran"), "drawn evaluate, drawn mesh, drawn smooth, drawn trace");
  pipeline("models: {bare: plane.ply, drawn: {file: plane.ply, inputs: {}}}\n");
  EXPECT_NE(must("strake run -n --explain").find("drawn smooth: without its input guides"),
            std::string::npos);
}

TEST_F(SideInputs, AreListsOfEdgesAndDensitiesToo) {
  must("strake run -q");
  std::ifstream plane(file("plane.ply"), std::ios::binary);
  std::string word;
  while (word != "vertex") plane >> word;
  int vertices = 0;
  plane >> vertices;
  std::string density = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
                        "\nproperty float density\nend_header\n";
  for (int v = 0; v < vertices; ++v) density += v % 2 == 0 ? "1\n" : "1.5\n";
  put("density.ply", density);
  pipeline(
      "models: {bare: plane.ply, drawn: {file: plane.ply, inputs: {guides: guides.obj, "
      "density: density.ply}}}\n");
  EXPECT_EQ(names(run_steps(), "ran"), "drawn evaluate, drawn mesh, drawn trace");
  put("edges.txt", "0 999999\n");
  pipeline("models: {drawn: {file: plane.ply, inputs: {feature-edges: edges.txt}}}\n");
  const Outcome outcome = run("strake run");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("there is no vertex 999999"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace strake::pipeline_test
