#include "tests/pipeline/run_program.h"

namespace strake::pipeline_test {
namespace {

/// A mesh with features, its tensors, and the tensors of its three parts.
class Parts : public ProgramTest {
 protected:
  Parts() {
    must("strake sample part -o part.ply --faces 9000");
    must("strake-import part.ply -o mesh.hdf -q");
    must("strake-tensor mesh.hdf -o tensor.hdf --radius 2% -q");
    for (const std::string number : {"1", "2", "3"}) make_part(number, "p" + number + ".hdf");
  }
  void make_part(const std::string& number, const std::string& name,
                 const std::string& options = "--parts 3 --radius 2%") {
    must("strake-tensor-part mesh.hdf -o " + name + " --part " + number + " " + options + " -q");
  }
  void must_not_merge(const std::string& files, const std::string& message) {
    must_fail(kPrecondition, "strake-tensor-merge mesh.hdf " + files + " -o t.hdf", message);
  }
};

TEST_F(Parts, MergeToTheFileOfOneRun) {
  must("strake-tensor-merge mesh.hdf p2.hdf p3.hdf p1.hdf -o merged.hdf -q");
  EXPECT_EQ(bytes("merged.hdf"), bytes("tensor.hdf"));
  must("strake-smooth mesh.hdf merged.hdf -o field.hdf -q");
}

TEST_F(Parts, AreTheSameForAnyThreadCount) {
  make_part("2", "one.hdf", "--parts 3 --radius 2% --threads 1");
  EXPECT_EQ(bytes("one.hdf"), bytes("p2.hdf"));
}

TEST_F(Parts, AreSoundArtifacts) {
  EXPECT_NE(must("strake check p1.hdf").find("tensor_part"), std::string::npos);
  EXPECT_NE(must("strake info p1.hdf").find("--part 1"), std::string::npos);
}

TEST_F(Parts, MissingAndRepeatedOnesAreNamed) {
  must_not_merge("p1.hdf p3.hdf", "part 2 of 3 is missing");
  must_not_merge("p1.hdf p2.hdf p3.hdf p2.hdf", "part 2 of 3 is given twice");
  must_fail(kUsage, "strake-tensor-merge mesh.hdf -o t.hdf", "parts");
}

TEST_F(Parts, OnesMadeInDifferentWaysAreRefused) {
  make_part("3", "wide.hdf", "--parts 3 --radius 3%");
  must_not_merge("p1.hdf p2.hdf wide.hdf", "'wide.hdf' was made with other options");
  make_part("3", "of4.hdf", "--parts 4 --radius 2%");
  must_not_merge("p1.hdf p2.hdf of4.hdf", "part 3 of 4");
}

TEST_F(Parts, OnesOfAnotherMeshAreRefused) {
  must("strake sample torus -o torus.ply --faces 2000");
  must("strake-import torus.ply -o torus.hdf -q");
  must("strake-tensor-part torus.hdf -o torus1.hdf --radius 2% -q");
  must_not_merge("torus1.hdf", "another mesh");
}

TEST_F(Parts, WrongUseAndDamage) {
  must_fail(kUsage, "strake-tensor-part mesh.hdf -o p.hdf --parts 4 --part 5", "only 4 parts");
  must_fail(kUsage, "strake-tensor-part mesh.hdf -o mesh.hdf", "is the input");
  must_fail(kUsage, "strake-tensor-merge mesh.hdf p1.hdf p2.hdf p3.hdf -o p2.hdf", "is the input");
  must_fail(kBadInput, "strake-tensor-part tensor.hdf -o p.hdf", "'mesh' is needed");
  must_fail(kBadInput, "strake-tensor-part nowhere.hdf -o p.hdf", "nowhere.hdf");
  std::string damaged = bytes("mesh.hdf");
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 4);
  put("damaged.hdf", damaged);
  must_fail(kBadInput, "strake-tensor-part damaged.hdf -o p.hdf", "damaged.hdf");
}

}  // namespace
}  // namespace strake::pipeline_test
