#include <unistd.h>

#include <fstream>

#include "tests/pipeline/pipeline_run.h"

namespace strake::pipeline_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAll =
    "torus evaluate, torus export.obj, torus import, torus mesh, torus smooth, torus tensor, "
    "torus trace";
constexpr const char* kFromTrace = "torus evaluate, torus export.obj, torus mesh, torus trace";

/// One model in a file, run once.
class Incremental : public PipelineTest {
 protected:
  Incremental() {
    must("strake sample torus -o torus.obj --faces 2000");
    describe("1");
    const auto steps = run_steps();
    EXPECT_EQ(names(steps, "ran"), kAll);
  }
  void describe(const std::string& seed) const {
    pipeline("models: [torus.obj]\noptions: {trace: {seed: " + seed +
             "}}\noutputs: {quads: 'out/{model}.obj', report: 'out/{model}.json'}\n");
  }
  /// \param wrote  what of the outputs that are up to date in the store is written
  void expect_nothing_to_do(const std::string& wrote = "") {
    const std::string said = must("strake run");
    EXPECT_EQ(said, wrote + "0 steps run, 7 in the store\n");
  }
};

TEST_F(Incremental, NothingChangedRunsNothing) { expect_nothing_to_do(); }

TEST_F(Incremental, AnotherSeedRunsTraceAndWhatFollows) {
  const std::string before = bytes("out/torus.obj");
  describe("7");
  EXPECT_EQ(names(run_steps(), "ran"), kFromTrace);
  EXPECT_NE(bytes("out/torus.obj"), before);
  describe("1");
  expect_nothing_to_do("wrote out/torus.obj\nwrote out/torus.json\n");
  EXPECT_EQ(bytes("out/torus.obj"), before) << "the output is that of the present options again";
}

TEST_F(Incremental, TheFileOfAnotherModelMayBeGone) {
  pipeline("models: [torus.obj, gone.obj]\noptions: {trace: {seed: 1}}\n");
  EXPECT_EQ(must("strake run torus"), "0 steps run, 6 in the store\n");
  const std::string status = must("strake status");
  EXPECT_NE(status.find("torus/default     ready"), std::string::npos) << status;
  EXPECT_NE(status.find("missing  gone: there is no file '"), std::string::npos) << status;
  for (const std::string command : {"run", "run gone", "gc --unreachable"}) {
    must_fail(kUsage, "strake " + command, "gone.obj'");
  }
}

TEST_F(Incremental, TouchedModelRunsNothing) {
  fs::last_write_time(file("torus.obj"), fs::file_time_type::clock::now());
  expect_nothing_to_do();
  fs::rename(file("torus.obj"), file("moved.obj"));
  fs::copy_file(file("moved.obj"), file("torus.obj"));
  expect_nothing_to_do();
}

TEST_F(Incremental, ChangedCoordinateRunsAll) {
  std::string text = bytes("torus.obj");
  const std::size_t digit = text.find_last_of("0123456789", text.find('\n', text.find("\nv ") + 1));
  text[digit] = text[digit] == '1' ? '2' : '1';
  put("torus.obj", text);
  EXPECT_EQ(names(run_steps(), "ran"), kAll);
}

TEST_F(Incremental, ChangeThatKeepsSizeAndTimeIsSeen) {
  const auto time = fs::last_write_time(file("torus.obj"));
  std::string text = bytes("torus.obj");
  const std::size_t digit = text.find_last_of("0123456789", text.find('\n', text.find("\nv ") + 1));
  text[digit] = text[digit] == '1' ? '2' : '1';
  put("torus.obj", text);
  fs::last_write_time(file("torus.obj"), time);
  EXPECT_EQ(names(run_steps(), "ran"), kAll);
}

TEST_F(Incremental, AnotherCommentImportsOnly) {
  put("torus.obj", "# saved again\n" + bytes("torus.obj"));
  const auto steps = run_steps();
  EXPECT_EQ(names(steps, "ran"), "torus import");
  EXPECT_EQ(steps.size(), 7u);
  EXPECT_EQ(names(steps, "found"),
            "torus evaluate, torus export.obj, torus mesh, torus smooth, torus tensor, "
            "torus trace");
  expect_nothing_to_do();
}

TEST_F(Incremental, WrittenDefaultsChangeNothing) {
  pipeline(
      "models: [torus.obj]\noptions: {import: {feature-angle: 40.0}, trace: {seed: 01}}\n"
      "outputs: {quads: 'out/{model}.obj', report: 'out/{model}.json'}\n");
  expect_nothing_to_do();
}

TEST_F(Incremental, AnOutputIsWrittenAgainFromTheStore) {
  const std::string whole = bytes("out/torus.obj");
  fs::remove(file("out/torus.obj"));
  put("out/torus.json", "scribbled\n");
  expect_nothing_to_do("wrote out/torus.obj\nwrote out/torus.json\n");
  EXPECT_EQ(bytes("out/torus.obj"), whole);
  EXPECT_NE(bytes("out/torus.json"), "scribbled\n");
}

TEST_F(Incremental, ACopiedStoreIsAsGood) {
  fs::rename(file("store"), file("old"));
  fs::copy(file("old"), file("store"), fs::copy_options::recursive);
  fs::remove_all(file("old"));
  expect_nothing_to_do();
}

/// What differs is told from the result of the same variant, wherever that of another lies.
TEST_F(Incremental, ExplainComparesWithTheSameVariant) {
  pipeline("models: [torus.obj]\nvariants: {v: {trace: {seed: [1, 2, 3, 4]}}}\n");
  must("strake run -q --until trace");
  for (const std::string seed : {"1", "2", "3", "4"}) {
    const std::string said = must("strake run -n --explain --set trace.seed=77 torus/v-" + seed);
    EXPECT_NE(said.find("seed " + seed + " -> 77"), std::string::npos) << said;
  }
}

TEST_F(Incremental, VariantsShareWhatTheyDoNotChange) {
  pipeline(
      "models: [torus.obj]\nvariants: {a: {}, b: {trace: {seed: 2}}, c: {trace: {seed: 1}}}\n");
  const auto steps = run_steps();
  EXPECT_EQ(names(steps, "ran"), "torus evaluate (b), torus mesh (b), torus trace (b)");
}

}  // namespace
}  // namespace strake::pipeline_test
