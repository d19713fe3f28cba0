#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "common/artifact/artifact.h"
#include "tests/pipeline/run_program.h"

namespace strake::pipeline_test {
namespace {

class Errors : public ProgramTest {
 protected:
  Errors() {
    must("strake sample torus -o torus.ply --faces 2000");
    must("strake-import torus.ply -o mesh.hdf -q");
  }
};

TEST_F(Errors, WrongUsage) {
  must_fail(kUsage, "strake-tensor mesh.hdf", "--output");
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.hdf --radius 99%", "--radius");
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.hdf --radius 99%", "between 0.01% and 50%");
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.hdf --no-such-option 3", "--no-such-option");
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.obj", ".hdf");
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.hdf --threads -2", "--threads");
  must_fail(kUsage, "strake-tensor mesh.hdf -o mesh.hdf", "is the input");
  must_fail(kUsage, "strake remesh torus.ply -o torus.stl", ".obj");
  must_fail(kUsage, "strake remesh torus.ply -o torus.ply", "is the input");
  must_fail(kUsage, "strake remesh torus.ply -o x.obj --vertices 100 --faces 100", "exclude");
  must_fail(kUsage, "strake remesh torus.ply -o ./guides.obj --guides guides.obj", "'guides'");
  must_fail(kUsage, "strake remesh torus.ply -o x.obj --report torus.ply", "is the input");
  must_fail(kUsage, "strake remesh torus.ply -o x.obj --report ./x.obj", "is the output");
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.hdf --report mesh.hdf", "is the input");
  must_fail(kUsage, "strake remesh torus.ply -o x.obj --extension papier", "cross, paper");
  must_fail(kUsage, "strake remesh torus.ply -o x.obj --density \"\"", "--density names no file");
  must_fail(kUsage, "strake remesh torus.ply -o x.obj --keep \"\"", "--keep names no folder");
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.hdf --report \"\"", "--report names no file");
  must_fail(kUsage, "strake nothing", "no command");
  must_fail(kUsage, "strake", "subcommand");
  must_fail(kUsage, "strake sample teapot -o x.ply", "teapot");
}

TEST_F(Errors, MissingAndUnreadableFiles) {
  must_fail(kBadInput, "strake-tensor nowhere.hdf -o t.hdf", "nowhere.hdf");
  must_fail(kBadInput, "strake remesh nowhere.obj -o x.obj", "nowhere.obj");
  must_fail(kBadInput, "strake remesh . -o x.obj", ".: is a folder");
  must_fail(kBadInput, "strake-tensor mesh.hdf -o nowhere/t.hdf", "nowhere");
  must_fail(kBadInput, "strake info nowhere.obj", "nowhere.obj");
  must_fail(kBadInput, "strake remesh torus.ply -o x.obj --report nowhere/r.json", "nowhere");
  must_fail(kBadInput, "strake-tensor mesh.hdf -o t.hdf --report nowhere/r.json", "nowhere");
  for (const char* output : {"x.obj", "t.hdf"}) EXPECT_FALSE(std::filesystem::exists(file(output)));
}

/// Opening one waits for somebody who writes into it, and signals do not end that.
TEST_F(Errors, PipesAreRefusedAtOnce) {
  ASSERT_EQ(shell("mkfifo pipe.obj").exit_code, 0);
  for (const std::string command :
       {"strake remesh pipe.obj -o x.obj", "strake info pipe.obj", "strake check pipe.obj",
        "strake check mesh.hdf pipe.obj", "strake-import pipe.obj -o m.hdf",
        "strake-tensor pipe.obj -o t.hdf", "strake run -f pipe.obj", "strake status -f pipe.obj",
        "strake remesh torus.ply -o x.obj --guides pipe.obj",
        "strake-import torus.ply -o m.hdf --feature-edges pipe.obj",
        "strake-render torus.ply -o x.png --lines pipe.obj"}) {
    const Outcome outcome = shell("timeout -s KILL 10 " STRAKE_BIN "/" + command);
    EXPECT_EQ(outcome.exit_code, kBadInput) << command << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find("pipe.obj"), std::string::npos) << outcome.err;
  }
}

TEST_F(Errors, LengthsInModelUnitsThatAreOutOfRange) {
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.hdf --radius 1e9", "option --radius: '1e+09' is ");
  must_fail(kUsage, "strake-tensor mesh.hdf -o t.hdf --radius 1e9", "between 0.01% and 50%");
  must_fail(kUsage, "strake-import torus.ply -o m.hdf --feature-height 1e9", "--feature-height");
  for (const std::string length : {"1e300", "1e-7"}) {
    must_fail(kUsage, "strake remesh torus.ply -o x.obj --tolerance " + length,
              "of the bounding-box diagonal, ");
    must_fail(kUsage, "strake remesh torus.ply -o x.obj --tolerance " + length,
              "expected a length between 0.0001% and 20%");
  }
}

TEST_F(Errors, AnOutputStreamThatIsFull) {
  for (const std::string command :
       {"strake info mesh.hdf", "strake schema", "strake completion bash", "strake check mesh.hdf",
        "strake --help", "strake --version", "strake-import --help"}) {
    const Outcome outcome = shell("{ " STRAKE_BIN "/" + command + " > /dev/full; }");
    EXPECT_EQ(outcome.exit_code, kBadInput) << command;
    EXPECT_NE(outcome.err.find("the standard output cannot be written"), std::string::npos)
        << command << ": " << outcome.err;
    EXPECT_EQ(outcome.err.find("internal"), std::string::npos) << outcome.err;
  }
}

/// Whoever keeps only the last line of what is said finds the error there.
TEST_F(Errors, FiguresThatCannotBeWrittenAreNotPrinted) {
  run_chain("torus.ply", "torus-");
  const std::string evaluate = "strake-evaluate torus-mesh.hdf torus-quads.hdf";
  EXPECT_NE(must(evaluate), "");
  for (const std::string option : {"-o", "--report"}) {
    const Outcome outcome = run(evaluate + " " + option + " nowhere/figures.json");
    EXPECT_EQ(outcome.exit_code, kBadInput) << option;
    EXPECT_EQ(outcome.out, "") << option;
    EXPECT_NE(outcome.err.find("nowhere"), std::string::npos) << option;
  }
}

TEST_F(Errors, FilesOfAnotherKind) {
  must_fail(kBadInput, "strake-tensor torus.ply -o t.hdf", "torus.ply");
  must_fail(kBadInput, "strake-smooth mesh.hdf mesh.hdf -o f.hdf", "'tensor' is needed");
  put("text.obj", "nothing of use\n");
  must_fail(kBadInput, "strake remesh text.obj -o x.obj", "text.obj");
}

TEST_F(Errors, DamagedFiles) {
  const std::string whole = bytes("mesh.hdf");
  put("cut.hdf", whole.substr(0, whole.size() / 2));
  must_fail(kBadInput, "strake-tensor cut.hdf -o t.hdf", "cut.hdf");
  must_fail(kBadInput, "strake check cut.hdf", "cut.hdf");
  std::string flipped = whole;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 4);
  put("flipped.hdf", flipped);
  must_fail(kBadInput, "strake-tensor flipped.hdf -o t.hdf", "flipped.hdf");
}

/// What a viewer reads is checked, too, though no stage reads it: one flipped bit anywhere.
TEST_F(Errors, CheckTellsRotFromTruncation) {
  run_chain("torus.ply", "");
  const std::string whole = bytes("field.hdf");
  put("cut.hdf", whole.substr(0, whole.size() / 2));
  must_fail(kBadInput, "strake check cut.hdf", "is cut off after");
  std::size_t noticed = 0;
  constexpr std::size_t kTried = 40;
  for (std::size_t n = 0; n < kTried; ++n) {
    std::string rotten = whole;
    // Behind the first bytes, without which it is no artifact; gaps between datasets hold nothing.
    char& byte = rotten[1000 + n * (whole.size() - 1000) / kTried];
    byte = static_cast<char>(byte ^ 4);
    put("rotten.hdf", rotten);
    noticed += run("strake check rotten.hdf").exit_code == kBadInput ? 1 : 0;
  }
  EXPECT_GE(noticed, kTried * 9 / 10);
  put("rotten.hdf", bytes("field.hdf"));
  must("strake check rotten.hdf");
}

/// What another program wrote into it has a checksum of its own, but not the content that others
/// name as theirs.
TEST_F(Errors, CheckTellsThatAMeshWasChanged) {
  must("strake check mesh.hdf");
  TriMesh mesh = read_tri_mesh(file("mesh.hdf"));
  mesh.positions[0].x() += 0.01 * mesh.diagonal;
  write_artifact(file("changed.hdf"), mesh, {});
  must_fail(kBadInput, "strake check changed.hdf", "changed after it was made");
}

/// A program that knows nothing of the attribute `content` leaves the old one.
TEST_F(Errors, CheckTellsThatAFieldWasChanged) {
  run_chain("torus.ply", "");
  must("strake check field.hdf mesh.hdf");
  const std::string script =
      "import h5py\nwith h5py.File('field.hdf', 'r+') as f: f['field/k_max'][...] *= 3\n";
  put("change.py", script);
  ASSERT_EQ(shell("/usr/bin/python3 change.py").exit_code, 0);
  must("strake check field.hdf");  // without its mesh nobody can tell
  must_fail(kBadInput, "strake check field.hdf mesh.hdf", "changed after it was made");
}

TEST_F(Errors, CheckTakesArtifactsFromBeforeTheyHadAContent) {
  run_chain("torus.ply", "");
  const std::string change =
      "import h5py, numpy\n"
      "with h5py.File('mesh.hdf', 'r+') as f: del f.attrs['content']\n"
      "with h5py.File('field.hdf', 'r+') as f: f.attrs['provenance'] = numpy.bytes_('{}')\n";
  put("change.py", change);
  ASSERT_EQ(shell("/usr/bin/python3 change.py").exit_code, 0);
  must("strake check mesh.hdf");
  must_fail(kBadInput, "strake check field.hdf", "field.hdf: 'provenance' does not say");
}

TEST_F(Errors, CheckTellsUnsoundMeshesFromDamagedFiles) {
  put("book.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
  must_fail(kAlgorithmFailed, "strake check book.obj", "book.obj is not sound");
  must_fail(kBadInput, "strake check none.obj book.obj", "none.obj");
}

/// What every stage refuses is not sound.
TEST_F(Errors, CheckTellsWhatStagesRefuse) {
  run_chain("torus.ply", "");
  const TriMesh mesh = read_tri_mesh(file("mesh.hdf"));
  LineSet lines = read_line_set(file("lines.hdf"));
  lines.spacing_along_min[0] = -1;
  write_artifact(file("bad.hdf"), lines, mesh, {});
  must_fail(kBadInput, "strake-mesh mesh.hdf bad.hdf -o q.hdf", "distances of lines");
  must_fail(kBadInput, "strake check bad.hdf", "distances of lines");
  const PrincipalField good = read_principal_field(file("field.hdf"));
  PrincipalField field = good;
  field.normal[0] *= 1.1;
  write_artifact(file("bad.hdf"), field, mesh, {});
  must_fail(kBadInput, "strake check bad.hdf", "not of length 1");
  field = good;
  field.cross[0] = field.normal[0];
  write_artifact(file("bad.hdf"), field, mesh, {});
  must_fail(kBadInput, "strake check bad.hdf", "not orthogonal");
  field = good;
  field.face_confidence[0] = 5;
  write_artifact(file("bad.hdf"), field, mesh, {});
  must_fail(kBadInput, "strake check bad.hdf", "between 0 and 1");
}

TEST_F(Errors, NobodyHasToListen) {
  for (const char* closed :
       {"2>/dev/full", "2>&-", "<&- 2>&-", ">/dev/null 2>/dev/full --log-json"}) {
    const Outcome outcome = shell("(" STRAKE_BIN
                                  "/strake remesh torus.ply -o heard.obj --vertices "
                                  "300 " +
                                  std::string(closed) + ")");
    EXPECT_EQ(outcome.exit_code, 0) << closed;
    EXPECT_TRUE(std::filesystem::remove(file("heard.obj"))) << closed;
  }
  EXPECT_EQ(shell("(" STRAKE_BIN "/strake remesh none.ply -o x.obj 2>/dev/full)").exit_code,
            kBadInput);
}

/// A scan that is written again while it is remeshed.
TEST_F(Errors, InputsAreNotReadAgainAtTheEnd) {
  const Outcome outcome = shell("( cp torus.ply going.ply && " STRAKE_BIN
                                "/strake remesh going.ply -o going.hdf --vertices "
                                "300 2>&1 | while read line; do case $line in tensor*) echo other "
                                "> going.ply;; esac; done )");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(bytes("going.ply"), "other\n");
  must("strake check torus.ply going.hdf");
}

TEST_F(Errors, CheckTellsStaleFromForeign) {
  run_chain("torus.ply", "");
  must("strake check torus.ply mesh.hdf tensor.hdf field.hdf lines.hdf");
  // A chain fits what was refined from an earlier fit, which it does not keep.
  must("strake remesh torus.ply -o q.obj --vertices 300 --keep kept -q");
  must("strake check torus.ply kept/mesh.hdf kept/fitted.hdf kept/refined.hdf kept/quads.hdf");
  // Nor does it keep what its result within a tolerance was not made from.
  must("strake remesh torus.ply -o q.obj --tolerance 0.5% --keep kept -q");
  std::string kept;
  for (const auto& entry : std::filesystem::directory_iterator(file("kept"))) {
    if (entry.path().extension() == ".hdf") kept += " " + entry.path().string();
  }
  EXPECT_NE(kept.find("refined.hdf"), std::string::npos);
  must("strake check torus.ply" + kept);
  must("strake remesh torus.ply -o whole.hdf --vertices 300 -q");
  must("strake check torus.ply whole.hdf");
  must("strake check lines.hdf mesh.hdf");  // what is not given is not missed
  must("strake-smooth mesh.hdf tensor.hdf -o other.hdf -q --iterations 9");
  must_fail(
      kPrecondition, "strake check mesh.hdf other.hdf lines.hdf",
      "lines.hdf: stale: made from another 'field' than 'other.hdf' is now; run strake-trace");
  must("strake check mesh.hdf other.hdf field.hdf lines.hdf");
  must("strake sample sphere -o sphere.ply --faces 500");
  must_fail(kPrecondition, "strake check sphere.ply mesh.hdf",
            "mesh.hdf: stale: made from another 'input' than 'sphere.ply'");
  must_fail(kPrecondition, "strake check sphere.ply whole.hdf",
            "whole.hdf: stale: made from another 'input' than 'sphere.ply' is now; run strake "
            "remesh again");
  must("strake-import sphere.ply -o sphere.hdf -q");
  must_fail(kPrecondition, "strake check sphere.hdf lines.hdf",
            "lines.hdf: foreign: it belongs to another mesh than 'sphere.hdf'");
  must_fail(kUsage, "strake check pipeline.yaml", "strake status --verify --file pipeline.yaml");
  put("cut.hdf", bytes("mesh.hdf").substr(0, 5000));
  must_fail(kBadInput, "strake check cut.hdf sphere.hdf lines.hdf", "foreign");
}

/// Every index of the file is in range, and yet one vertex has two fans of faces.
TEST_F(Errors, MeshesThatBreakWhatTheyPromise) {
  TriMesh bow;
  bow.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(-1, 0, 0), Vec3(-1, -1, 0)};
  bow.faces = {{0, 1, 2}, {0, 3, 4}};
  bow.face_wedges = bow.faces;
  bow.wedge_vertex = bow.source_vertex = {0, 1, 2, 3, 4};
  bow.source_face = {0, 1};
  bow.twin.assign(6, kNone);
  bow.vertex_out = {0, 1, 2, 4, 5};
  bow.is_feature.assign(6, 0);
  bow.is_corner.assign(5, 0);
  bow.diagonal = 2;
  bow.id = std::string(32, '0');
  write_artifact(file("bow.hdf"), bow, {});
  must_fail(kBadInput, "strake-tensor bow.hdf -o t.hdf", "vertex 0 has several fans");
}

/// What a stage makes of numbers that overflow is no result, and can be sent to whoever mends that.
TEST_F(Errors, UnsoundResultsAreNotWrittenAndCanBeRepeated) {
  must("strake-tensor mesh.hdf -o tensor.hdf -q");
  TensorField field = read_tensor_field(file("tensor.hdf"));
  for (auto& tensor : field.tensor) tensor = {1e308, 0, 0, 1e308, 0, 1e308};
  write_artifact(file("huge.hdf"), field, read_tri_mesh(file("mesh.hdf")), {});
  const std::string command = "strake-smooth mesh.hdf huge.hdf -o f.hdf --field-stiffness 7";
  must_fail(kInternal, command, "is unsound");
  const Outcome kept = run(command + " --repro failed");
  EXPECT_EQ(kept.exit_code, kInternal);
  EXPECT_NE(kept.err.find("are in 'failed'"), std::string::npos) << kept.err;
  EXPECT_EQ(bytes("failed/1-mesh.hdf"), bytes("mesh.hdf"));
  EXPECT_EQ(bytes("failed/2-huge.hdf"), bytes("huge.hdf"));
  const std::string repro = bytes("failed/repro.json");
  for (const char* part :
       {"is unsound", "strake-smooth 0.", "built by", "2-huge.hdf", "field-stiffness", "\"7\""}) {
    EXPECT_NE(repro.find(part), std::string::npos) << part << " in\n" << repro;
  }
  must_fail(kInternal, "strake-smooth failed/1-mesh.hdf failed/2-huge.hdf -o f.hdf", "is unsound");
  must_fail(kInternal, command + " --repro mesh.hdf", "nothing was kept");
  std::istringstream log(run(command + " --repro failed --log-json").err);
  std::string said;
  for (std::string line; std::getline(log, line);) {
    said = nlohmann::json::parse(line).value("text", said);
  }
  EXPECT_NE(said.find("are in 'failed'"), std::string::npos) << said;
  // Nothing is kept of faults of the input.
  must_fail(kBadInput, "strake-smooth mesh.hdf nowhere.hdf -o f.hdf --repro none", "nowhere.hdf");
  EXPECT_FALSE(std::filesystem::exists(file("none")));
}

TEST_F(Errors, InputsThatDoNotBelongTogether) {
  must("strake sample sphere -o sphere.ply --faces 2000");
  must("strake-import sphere.ply -o sphere.hdf -q");
  must("strake-tensor sphere.hdf -o tensor.hdf -q");
  must_fail(kPrecondition, "strake-smooth mesh.hdf tensor.hdf -o f.hdf", "another mesh");
}

TEST_F(Errors, UnsoundMeshesFailTheCheck) {
  put("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 1 2 4\n");
  must_fail(kAlgorithmFailed, "strake check open.obj", "not sound");
  put("pentagon.obj", "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n");
  must("strake check pentagon.obj");
  must_fail(kAlgorithmFailed, "strake check pentagon.obj --max-sides 4", "5 sides");
  must("strake check torus.ply");
}

TEST_F(Errors, OldOutputSurvivesAFailure) {
  put("out.obj", "old\n");
  put("bad.obj", "f 1 2 3\n");
  must_fail(kBadInput, "strake remesh bad.obj -o out.obj", "bad.obj");
  EXPECT_EQ(bytes("out.obj"), "old\n");
}

TEST_F(Errors, InterruptionStopsWithoutOutput) {
  must("strake sample sphere -o large.ply --faces 300000");
  const std::string program = STRAKE_BIN "/strake";
  put("interrupt.sh", program +
                          " remesh large.ply -o large.obj 2>err.txt & p=$!\n"
                          "until grep -q tensor: err.txt; do sleep 0.02; done\n"
                          "kill -TERM $p\nwait $p\n");
  const Outcome outcome = shell("bash interrupt.sh");
  EXPECT_EQ(outcome.exit_code, kInterrupted) << bytes("err.txt");
  EXPECT_FALSE(std::filesystem::exists(file("large.obj")));
}

/// Where the program was ended by the second signal, files that were not whole stayed behind.
TEST_F(Errors, SecondInterruptionEndsInOrder) {
  must("strake sample sphere -o large.ply --faces 300000");
  const std::string program = STRAKE_BIN "/strake";
  put("interrupt.sh", program +
                          " remesh large.ply -o large.obj 2>err.txt & p=$!\n"
                          "until grep -q tensor: err.txt; do sleep 0.02; done\n"
                          "kill -TERM $p\nkill -INT $p\nkill -TERM $p\nwait $p\n");
  EXPECT_EQ(shell("bash interrupt.sh").exit_code, kInterrupted) << bytes("err.txt");
  EXPECT_NE(bytes("err.txt").find("interrupted"), std::string::npos) << bytes("err.txt");
}

}  // namespace
}  // namespace strake::pipeline_test
