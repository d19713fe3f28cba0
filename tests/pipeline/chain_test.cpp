#include "common/artifact/artifact.h"
#include "tests/pipeline/run_program.h"

namespace strake::pipeline_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kArtifacts = {"mesh.hdf",  "tensor.hdf", "field.hdf",
                                             "lines.hdf", "quads.hdf",  "fitted.hdf"};

class Chain : public ProgramTest {
 protected:
  Chain() { must("strake sample part -o part.ply --faces 9000"); }
};

TEST_F(Chain, GivesTheSameBytesForAnyThreadCount) {
  run_chain("part.ply", "one-", "--threads 1");
  run_chain("part.ply", "two-", "--threads 2");
  for (const std::string& name : kArtifacts) {
    EXPECT_EQ(bytes("one-" + name), bytes("two-" + name)) << name;
  }
}

TEST_F(Chain, FrontEndKeepsWhatThePrograms) {
  run_chain("part.ply", "");
  must("strake-evaluate mesh.hdf fitted.hdf --field field.hdf -o evaluate.json -q");
  must("strake remesh part.ply -o part.obj --keep kept -q --feedback-rounds 0");
  for (const std::string& name : kArtifacts) EXPECT_EQ(bytes(name), bytes("kept/" + name)) << name;
  EXPECT_EQ(bytes("evaluate.json"), bytes("kept/evaluate.json"));
  must("strake-fit mesh.hdf quads.hdf --field field.hdf -o again.obj -q");
  EXPECT_EQ(bytes("part.obj"), bytes("again.obj"));
}

TEST_F(Chain, FrontEndKeepsAToleranceAsThePrograms) {
  run_chain("part.ply", "");
  // Lines are closer where errors are too large.
  must("strake-size mesh.hdf field.hdf lines.hdf quads.hdf -o size.hdf -q --size-tolerance 0.045%");
  must("strake-trace mesh.hdf field.hdf -o lines.hdf -q --size size.hdf --tolerance 0.1%");
  must("strake-mesh mesh.hdf lines.hdf -o quads.hdf -q --border-distance 0.05%");
  must("strake-fit mesh.hdf quads.hdf --field field.hdf -o fitted.hdf -q");
  // Cells are divided and vertices fitted in turn, at last without: that could undo the tolerance.
  const std::string tolerance = " --refine-tolerance 0.1%";
  const std::string once = tolerance + " --refine-rounds 1 --refine-partly";
  must("strake-refine mesh.hdf fitted.hdf -o refined1.hdf -q" + once);
  must("strake-fit mesh.hdf refined1.hdf --field field.hdf -o fitted1.hdf -q");
  must("strake-refine mesh.hdf fitted1.hdf -o refined2.hdf -q" + once);
  must("strake-fit mesh.hdf refined2.hdf --field field.hdf -o fitted2.hdf -q");
  for (const char* output : {"again.obj", "refined.hdf"}) {
    must("strake-refine mesh.hdf fitted2.hdf --refine-sides 5 -q -o " + (output + tolerance));
  }
  // The programs above know of no tolerance when they look for features.
  must(
      "strake remesh part.ply -o part.obj --tolerance 0.1% --feature-height 100% --no-evaluate -q "
      "--keep kept");
  EXPECT_EQ(bytes("part.obj"), bytes("again.obj"));
  // They say what they were made from, though that was never a file.
  for (const std::string name : {"lines.hdf", "quads.hdf", "refined.hdf"}) {
    EXPECT_EQ(bytes(name), bytes("kept/" + name)) << name;
  }
  // The last fit was made from cells that are divided since; no other one is in its place.
  EXPECT_FALSE(std::filesystem::exists(file("kept/fitted.hdf")));
}

TEST_F(Chain, FrontEndKeepsWhatItWorksOnAsTheProgramsMakeIt) {
  must("strake sample torus -o torus.ply --faces 20000");
  must("strake remesh torus.ply -o torus.obj --vertices 200 --keep kept -q");
  must("strake-coarsen kept/mesh.hdf -o coarse.hdf --coarse-vertices 2000 -q");
  must("strake-tensor kept/mesh.hdf --coarse coarse.hdf -o coarse-tensor.hdf -q");
  must("strake-smooth coarse.hdf coarse-tensor.hdf -o coarse-field.hdf -q");
  must("strake-prolong kept/mesh.hdf coarse.hdf coarse-field.hdf -o field.hdf -q");
  for (const std::string name :
       {"coarse.hdf", "coarse-tensor.hdf", "coarse-field.hdf", "field.hdf"}) {
    EXPECT_EQ(bytes(name), bytes("kept/" + name)) << name;
  }
  must("strake check kept/mesh.hdf coarse.hdf coarse-tensor.hdf coarse-field.hdf field.hdf");
  must("strake-trace coarse.hdf coarse-field.hdf -o lines.hdf --vertices 200 -q");
  must("strake-mesh coarse.hdf lines.hdf -o coarse-quads.hdf -q");
  must("strake-lift kept/mesh.hdf coarse.hdf coarse-quads.hdf -o lifted.hdf -q");
  must("strake-evaluate kept/mesh.hdf lifted.hdf --field kept/field.hdf -o lifted.json -q");
  must(
      "strake-render kept -o lines.png --size 90x90 --surface input --colour plain --layers "
      "minimum");
  must_fail(4, "strake-lift kept/mesh.hdf kept/mesh.hdf coarse-quads.hdf -o wrong.hdf -q",
            "no coarser mesh of that of");
  must_fail(4, "strake-tensor kept/mesh.hdf --coarse kept/mesh.hdf -o wrong.hdf -q",
            "no coarser mesh of that of");
  must_fail(4, "strake-trace kept/mesh.hdf coarse-field.hdf -o wrong.hdf -q", "another mesh");
  STRAKE_VIEWER_OR_SKIP();
  must("strake report kept -o report.html");
}

TEST_F(Chain, AnotherSeedNeedsOnlyTraceAndMeshAgain) {
  run_chain("part.ply", "");
  const std::string field = bytes("field.hdf");
  must("strake-trace mesh.hdf field.hdf -o lines7.hdf --seed 7 -q");
  must("strake-mesh mesh.hdf lines7.hdf -o quads7.hdf -q");
  must("strake-fit mesh.hdf quads7.hdf --field field.hdf -o fitted7.hdf -q");
  EXPECT_EQ(bytes("field.hdf"), field);
  must("strake remesh part.ply -o whole.obj --seed 7 --keep kept -q --feedback-rounds 0");
  EXPECT_EQ(bytes("field.hdf"), bytes("kept/field.hdf"));
  EXPECT_EQ(bytes("lines7.hdf"), bytes("kept/lines.hdf"));
  EXPECT_EQ(bytes("quads7.hdf"), bytes("kept/quads.hdf"));
  EXPECT_EQ(bytes("fitted7.hdf"), bytes("kept/fitted.hdf"));
}

TEST_F(Chain, RunningAgainLeavesTheFilesAlone) {
  run_chain("part.ply", "");
  std::vector<fs::file_time_type> times;
  for (const std::string& name : kArtifacts) {
    fs::last_write_time(file(name), fs::last_write_time(file(name)) - std::chrono::hours(1));
    times.push_back(fs::last_write_time(file(name)));
  }
  run_chain("part.ply", "");
  for (std::size_t i = 0; i < kArtifacts.size(); ++i) {
    EXPECT_EQ(fs::last_write_time(file(kArtifacts[i])), times[i]) << kArtifacts[i];
  }
}

TEST_F(Chain, ArtifactsSayHowTheyWereMade) {
  must("strake-import part.ply -o mesh.hdf -q");
  must("strake-tensor mesh.hdf -o tensor.hdf -q --radius 2% --threads 1");
  const Provenance provenance = read_artifact_info(file("tensor.hdf")).provenance;
  EXPECT_EQ(provenance.stage, "tensor");
  EXPECT_EQ(provenance.options, (std::vector<Provenance::OptionRecord>{{"radius", "2%", false}}));
  ASSERT_EQ(provenance.inputs.size(), 1u);
  EXPECT_EQ(provenance.inputs[0].role, "mesh");
  EXPECT_EQ(provenance.inputs[0].digest.size(), 32u);
}

TEST_F(Chain, EveryArtifactPassesTheCheck) {
  run_chain("part.ply", "");
  for (const std::string& name : kArtifacts) {
    must("strake check " + name);
    EXPECT_NE(must("strake info " + name).find("made by"), std::string::npos);
  }
}

}  // namespace
}  // namespace strake::pipeline_test
