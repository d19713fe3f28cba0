#include <fstream>

#include "common/artifact/digest.h"
#include "common/artifact/store/store.h"
#include "tests/pipeline/pipeline_run.h"

namespace strake::pipeline_test {
namespace {

namespace fs = std::filesystem;

/// A store in which something is damaged between two runs.
class Damage : public PipelineTest {
 protected:
  Damage() {
    pipeline(
        "models: {torus: {sample: {kind: torus, faces: 2000}}}\n"
        "outputs: {quads: 'out/{model}.obj'}\n");
    must("strake run -q");
    whole_ = artifacts();
    field_ = artifact("torus/smooth-", "field.hdf");
    manifest_ = field_.parent_path() / "manifest.json";
  }

  [[nodiscard]] std::map<std::string, std::string> artifacts() const {
    std::map<std::string, std::string> all;
    for (const std::string& entry : entries()) {
      for (const auto& file : fs::directory_iterator(file("store") / entry)) {
        const std::string name = file.path().filename().string();
        if (name != "lock" && name != "manifest.json") {
          all[entry + "/" + name] = digest_file(file.path());
        }
      }
    }
    return all;
  }
  /// A run must say `part` on stderr, make this step again, and put all right.
  void expect_repair(const std::string& part, const std::string& arguments = "") {
    const Outcome outcome = run("strake run " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("torus smooth: ran"), std::string::npos) << outcome.err;
    EXPECT_EQ(artifacts(), whole_);
    EXPECT_EQ(must("strake run"), "0 steps run, 8 in the store\n");
  }

  /// A program of a stage that runs this first.
  void put_before(const std::string& stage, const std::string& commands) {
    const std::string program = "bin/strake-" + stage;
    fs::remove(file(program));
    put(program, "#!/bin/sh\n" + commands + "\nexec " STRAKE_BIN "/strake-" + stage + " \"$@\"\n");
    fs::permissions(file(program), fs::perms::owner_all);
  }
  /// All programs in the folder "bin", to put others in place of some.
  void copy_programs() {
    fs::create_directory(file("bin"));
    for (const auto& program : fs::directory_iterator(STRAKE_BIN)) {
      fs::create_symlink(program.path(), file("bin") / program.path().filename());
    }
    // `strake` finds the stages beside itself, so it has to be a copy.
    fs::remove(file("bin/strake"));
    fs::copy_file(STRAKE_BIN "/strake", file("bin/strake"));
  }

  std::map<std::string, std::string> whole_;  ///< digests of all artifacts
  fs::path field_;
  fs::path manifest_;
};

TEST_F(Damage, FlippedBit) {
  flip_bit(field_);
  expect_repair("field.hdf has other bytes than recorded");
}

TEST_F(Damage, FlippedBitWithTheOldTimeStamp) {
  const auto time = fs::last_write_time(field_);
  flip_bit(field_);
  fs::last_write_time(field_, time);
  expect_repair("field.hdf has other bytes than recorded");
}

TEST_F(Damage, Truncated) {
  fs::resize_file(field_, fs::file_size(field_) / 2);
  expect_repair("field.hdf has ");
}

TEST_F(Damage, Removed) {
  fs::remove(field_);
  expect_repair("field.hdf is missing");
}

TEST_F(Damage, EntryRemoved) {
  fs::remove_all(field_.parent_path());
  expect_repair("torus smooth");
}

TEST_F(Damage, ManifestTruncated) {
  fs::resize_file(manifest_, fs::file_size(manifest_) / 2);
  expect_repair("manifest cannot be read");
}

TEST_F(Damage, ManifestIsGarbage) {
  std::ofstream(manifest_) << "garbage";
  expect_repair("manifest cannot be read");
}

TEST_F(Damage, FlippedBitInAManifest) {
  flip_bit(manifest_);
  expect_repair("manifest");
}

TEST_F(Damage, StatusAndDryRunTellAndLeaveItAlone) {
  flip_bit(field_);
  const auto before = snapshot();
  EXPECT_NE(must("strake status --steps").find("damaged  torus smooth"), std::string::npos);
  EXPECT_NE(run("strake run --dry-run").err.find("field.hdf has other"), std::string::npos);
  EXPECT_EQ(snapshot(), before);
}

/// Scripts go by the exit code.
TEST_F(Damage, VerifiedStatusFails) {
  must("strake status --verify");
  fs::remove(artifact("torus/trace-", "lines.hdf"));
  flip_bit(field_);
  const auto before = snapshot();
  for (const std::string steps : {"", " --steps"}) {
    const Outcome outcome = run("strake status --verify" + steps);
    EXPECT_EQ(outcome.exit_code, kBadInput);
    EXPECT_NE(outcome.out.find("damaged"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("results, "), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.err.find("torus smooth: damaged: field.hdf has other bytes"),
              std::string::npos)
        << outcome.err;
  }
  EXPECT_EQ(snapshot(), before);
  must("strake run -q");
  must("strake status --verify");
}

TEST_F(Damage, AMissingProgramIsNamed) {
  copy_programs();
  fs::remove(file("bin/strake-trace"));
  const Outcome outcome = shell("bin/strake run --force trace");
  EXPECT_EQ(outcome.exit_code, kBadInput) << outcome.err;
  EXPECT_NE(outcome.err.find("bin/strake-trace' cannot be started"), std::string::npos)
      << outcome.err;
}

TEST_F(Damage, SeveralAtOnce) {
  flip_bit(field_);
  fs::remove(artifact("torus/import-", "mesh.hdf"));
  fs::remove_all(artifact("torus/trace-", "lines.hdf").parent_path());
  expect_repair("mesh.hdf is missing");
}

/// As a disk that rots: the stamps recorded are those of the damaged file.
class Rot : public Damage {
 protected:
  Rot() {
    flip_bit(field_);
    const Store store(file("store"));
    for (const Store::Listed& listed : store.list("torus")) {
      if (file("store") / listed.folder != field_.parent_path()) continue;
      Entry entry = listed.entry.value();
      store.add({"torus", "smooth", entry.key}, entry);
    }
    EXPECT_EQ(must("strake run"), "0 steps run, 8 in the store\n") << "nobody has looked at it";
  }
};

TEST_F(Rot, IsFoundBeforeUse) {
  const Outcome outcome = run("strake run --set trace.seed=7");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("field.hdf' is damaged; it will be made again"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(digest_file(field_), whole_.at(field_.lexically_relative(file("store")).string()));
}

TEST_F(Rot, IsFoundByVerify) {
  expect_repair("field.hdf has other bytes than recorded", "--verify");
}

/// Damage between the check of an input and its use: by a program in place of a stage's.
TEST_F(Damage, WhileTheConsumerRuns) {
  copy_programs();
  for (const char* damage :
       {"printf x | dd of=\"$2\" bs=1 seek=999 conv=notrunc", "rm -r \"${2%/*}\"", ": > \"$2\""}) {
    const std::string once = file("once").string();
    put_before("trace", "if [ ! -e " + once + " ]; then : > " + once + "; " + damage + " 2>&-; fi");
    fs::remove_all(artifact("torus/trace-", "lines.hdf").parent_path());
    const Outcome outcome = shell("bin/strake run");
    EXPECT_EQ(outcome.exit_code, 0) << damage << outcome.err;
    EXPECT_TRUE(fs::exists(file("once"))) << "nothing was damaged";
    EXPECT_NE(outcome.err.find("field.hdf' is "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("torus smooth: ran"), std::string::npos) << outcome.err;
    EXPECT_EQ(artifacts(), whole_);
    fs::remove(file("once"));
  }
}

/// What is asked for anew and was not reached before the damage is asked for still.
TEST_F(Damage, AForcedStepAfterItIsRunAllTheSame) {
  copy_programs();
  const std::string once = file("once").string();
  put_before("smooth", "if [ ! -e " + once + " ]; then : > " + once + "; rm -r \"${2%/*}\"; fi");
  fs::remove_all(field_.parent_path());
  const Outcome outcome = shell("bin/strake run --force smooth --force mesh");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("tensor.hdf' is gone"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("torus mesh: ran"), std::string::npos) << outcome.err;
  EXPECT_EQ(artifacts(), whole_);
}

/// As where `strake gc` is run again and again: what a step needs goes, but the run gets on.
TEST_F(Damage, InputsMayGoAsOftenAsTheRunGetsOn) {
  copy_programs();
  for (const std::string stage : {"tensor", "smooth", "trace", "mesh", "evaluate"}) {
    const std::string once = file("once-" + stage).string();
    put_before(stage, "if [ ! -e " + once + " ]; then : > " + once + "; rm -r \"${1%/*}\"; fi");
  }
  fs::remove_all(file("store"));
  const Outcome outcome = shell("bin/strake run");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(artifacts(), whole_);
}

TEST_F(Damage, ARunThatDoesNotGetOnEnds) {
  copy_programs();
  put_before("mesh", "rm -r \"${1%/*}\"");
  const Outcome outcome = shell("bin/strake run --set trace.seed=7");
  EXPECT_EQ(outcome.exit_code, kBadInput) << outcome.err;
  EXPECT_NE(outcome.err.find("keep being changed or damaged"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace strake::pipeline_test
