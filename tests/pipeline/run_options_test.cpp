#include <algorithm>
#include <fstream>

#include "common/artifact/digest.h"
#include "common/artifact/store/folder_lock.h"
#include "common/artifact/store/store.h"
#include "tests/pipeline/pipeline_run.h"

namespace strake::pipeline_test {
namespace {

namespace fs = std::filesystem;

class RunOptions : public PipelineTest {
 protected:
  RunOptions() {
    pipeline(
        "models: {torus: {sample: {kind: torus, faces: 2000}}}\noutputs: {quads: '{model}.obj'}\n");
  }
};

TEST_F(RunOptions, DryRunWritesNothing) {
  const auto before = snapshot();
  EXPECT_EQ(must("strake run --dry-run").find("run    torus sample\n"), 0u);
  EXPECT_EQ(snapshot(), before);
  must("strake run -q --until trace");
  const auto between = snapshot();
  const std::string said = must("strake run -n --explain");
  EXPECT_NE(said.find("cached torus trace: nothing"), std::string::npos) << said;
  EXPECT_NE(said.find("run    torus mesh: never made before"), std::string::npos) << said;
  EXPECT_NE(said.find("3 steps to run, 5 in the store"), std::string::npos) << said;
  EXPECT_EQ(snapshot(), between);
}

TEST_F(RunOptions, ExplainNamesWhatChanged) {
  must("strake run -q");
  const std::string said =
      must("strake run -n --explain --set trace.seed=7 --set mesh.max-sides=4");
  EXPECT_NE(said.find("run    torus trace: seed 1 -> 7\n"), std::string::npos) << said;
  EXPECT_NE(said.find("run    torus mesh: its input 'lines' has to be made first\n"),
            std::string::npos)
      << said;
}

TEST_F(RunOptions, SettingsOfStepsThatAreNotWantedAreNamed) {
  const auto warned = [&](const std::string& options) {
    return run("strake run -n " + options).err.find("--set mesh.max-sides changes nothing") !=
           std::string::npos;
  };
  EXPECT_TRUE(warned("--until trace --set mesh.max-sides=4"));
  EXPECT_FALSE(warned("--until mesh --set mesh.max-sides=4"));
  EXPECT_FALSE(warned("--set mesh.max-sides=4"));
  EXPECT_FALSE(warned("-q --until trace --set mesh.max-sides=4"));
}

TEST_F(RunOptions, UntilAndFrom) {
  EXPECT_EQ(names(run_steps("--until tensor"), "ran"), "torus import, torus sample, torus tensor");
  EXPECT_FALSE(fs::exists(file("torus.obj")));
  must_fail(kPrecondition, "strake run --from trace", "torus smooth");
  must_fail(kPrecondition, "strake run --from trace --until mesh", "torus smooth");
  must_fail(kUsage, "strake run --from mesh --until smooth", "leaves nothing to run");
  must_fail(kUsage, "strake submit -n --from trace --until import", "leaves nothing to run");
  EXPECT_EQ(names(run_steps("--from smooth --until trace"), "ran"), "torus smooth, torus trace");
  must_fail(kUsage, "strake run --from trase", "did you mean 'trace'");
  must_fail(kUsage, "strake run --until trase", "did you mean 'trace'");
  must_fail(kUsage, "strake run --force trase", "did you mean 'trace'");
  must_fail(kUsage, "strake run --set trace.seed", "trace.seed=7");
  must_fail(kUsage, "strake run tours", "did you mean 'torus'");
  must_fail(kUsage, "strake run --memory lots", "16GB");
  must_fail(kUsage, "strake run --memory 16", "16GB, a number and a unit");
  must_fail(kUsage, "strake run -n --memory lots", "16GB");
  must_fail(kUsage, "strake run --set trace.sed=3", "error: --set trace.sed=3: stage 'trace'");
  must_fail(kUsage, "strake run --set trace.faces=9 --set trace.vertices=9", "exclude each other");
}

/// A count that lines cannot give is told at once, and later, too: by the store.
TEST_F(RunOptions, MissedCountsAreTold) {
  // A torus takes a few rings of a few vertices each, and more than these.
  const std::string missed = "warning: 20 vertices were wanted, but the mesh of these lines has ";
  const std::string few = "--set trace.vertices=20";
  const Outcome first = run("strake run " + few);
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.err.find(missed), std::string::npos) << first.err;
  EXPECT_NE(must("strake status " + few).find("results with warnings: "), std::string::npos);
  EXPECT_NE(must("strake status --steps " + few).find(missed), std::string::npos);
  EXPECT_EQ(run("strake run --set trace.tolerance=0.3%").err.find("warning"), std::string::npos);
  EXPECT_EQ(must("strake status").find("warning"), std::string::npos);
}

TEST_F(RunOptions, SetIsForThisTimeOnly) {
  must("strake run -q");
  const std::string usual = bytes("torus.obj");
  EXPECT_EQ(names(run_steps("--set trace.seed=7"), "ran"),
            "torus evaluate, torus export.obj, torus mesh, torus trace");
  EXPECT_NE(bytes("torus.obj"), usual);
  EXPECT_EQ(must("strake run"), "wrote torus.obj\n0 steps run, 8 in the store\n");
  EXPECT_EQ(bytes("torus.obj"), usual);
}

TEST_F(RunOptions, ForceRunsAgainAndLeavesEqualBytesAlone) {
  must("strake run -q");
  const auto time = fs::last_write_time(artifact("torus/trace-", "lines.hdf"));
  const Outcome outcome = run("strake run --force trace --force import");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(names(steps_in(outcome.out), "ran"), "torus import, torus trace");
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
  EXPECT_EQ(fs::last_write_time(artifact("torus/trace-", "lines.hdf")), time);
}

TEST_F(RunOptions, ForceHoldsWhereInputsAreMadeAnewToo) {
  must("strake run -q");
  fs::remove(artifact("torus/import-", "mesh.hdf"));
  EXPECT_EQ(names(run_steps("--force trace"), "ran"), "torus import, torus trace");
}

TEST_F(RunOptions, ForceOfAWholeIsForItsParts) {
  put("pipeline.yaml",
      "version: 1\nmodels: {torus: {sample: {kind: torus, faces: 2000}}}\n"
      "stages: {import: {}, tensor: {resources: {parts: 2}}, smooth: {}}\n");
  must("strake run -q");
  EXPECT_EQ(names(run_steps("--force tensor"), "ran"),
            "torus tensor, torus tensor-1of2, torus tensor-2of2");
  EXPECT_EQ(names(run_steps(""), "ran"), "");
}

TEST_F(RunOptions, ForceWarnsWhereTheBytesDiffer) {
  must("strake run -q");
  const fs::path lines = artifact("torus/trace-", "lines.hdf");
  const std::string whole = digest_file(lines);
  const Store store(file("store"));
  for (const Store::Listed& listed : store.list()) {
    if (listed.folder.string().rfind("torus/trace-", 0) != 0) continue;
    flip_bit(lines);
    Entry entry = listed.entry.value();
    entry.digest = digest_file(lines);  // as if the stage had given this the first time
    store.add({"torus", "trace", entry.key}, entry);
  }
  const Outcome outcome = run("strake run --force trace");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("other bytes than before"), std::string::npos) << outcome.err;
  EXPECT_EQ(digest_file(lines), whole);
}

TEST_F(RunOptions, QuietSaysNothingButErrors) {
  const Outcome fine = run("strake run -q");
  EXPECT_EQ(fine.out + fine.err, "");
  put("bad.obj", "nothing of use\n");
  pipeline("models: [bad.obj]\n");
  const Outcome failed = run("strake run -q");
  EXPECT_EQ(failed.exit_code, kBadInput);
  EXPECT_EQ(failed.out, "");
  EXPECT_NE(failed.err.find("bad import: failed (3)"), std::string::npos) << failed.err;
}

TEST_F(RunOptions, OutputIsPlainWhereThereIsNoTerminal) {
  const Outcome outcome = run("strake run");
  EXPECT_EQ(outcome.err.find('\033'), std::string::npos);
  EXPECT_EQ(outcome.err.find('\r'), std::string::npos);
  EXPECT_EQ(outcome.err.find("[1/8] torus sample: ran, "), 0u) << outcome.err;
}

TEST_F(RunOptions, BytesDoNotDependOnTheNumberOfJobs) {
  must("strake run -q --jobs 1");
  const std::string one = bytes("torus.obj");
  fs::remove_all(file("store"));
  must("strake run -q --jobs 4");
  EXPECT_EQ(bytes("torus.obj"), one);
}

TEST_F(RunOptions, BadFilesLeaveNothingBehind) {
  put("pipeline.yaml", "version: 1\nmodels: {x: {sample: {kind: teapot}}}\n");
  must_fail(kUsage, "strake run", "pipeline.yaml:2:23: ");
  put("pipeline.yaml", "version: 1\nmodels: [missing.obj]\n");
  must_fail(kUsage, "strake run", "pipeline.yaml:2:10: there is no file");
  must_fail(kBadInput, "strake run -f nowhere.yaml", "nowhere.yaml");
  must_fail(kBadInput, "strake run -f .", "cannot be read");
}

TEST_F(RunOptions, AFileIsNoStore) {
  for (const char* command : {"run -n", "run", "status"}) {
    must_fail(kBadInput, std::string("strake ") + command + " --store pipeline.yaml", "is a file");
  }
}

TEST_F(RunOptions, TellsWhichOutputsAreMissing) {
  const std::string wanted = "write  torus.obj\n";
  EXPECT_NE(must("strake run -n").find(wanted), std::string::npos);
  must("strake run -q");
  EXPECT_EQ(must("strake run -n").find(wanted), std::string::npos);
  EXPECT_EQ(must("strake status").find("torus.obj"), std::string::npos);
  fs::remove(file("torus.obj"));
  EXPECT_NE(must("strake run -n").find(wanted), std::string::npos);
  EXPECT_NE(must("strake status").find("outputs missing or out of date: torus.obj;"),
            std::string::npos);
  EXPECT_NE(must("strake status --steps").find("torus.obj"), std::string::npos);
  EXPECT_NE(must("strake run").find("wrote torus.obj\n0 steps run"), std::string::npos);
}

/// What steps of a run still need is the last that `strake gc --max-size` takes.
TEST_F(RunOptions, InputsAreUsedByTheStepsThatReadThem) {
  must("strake run -q");
  const auto used = [&](const char* entry, const char* name) {
    return fs::last_write_time(artifact(entry, name).parent_path() / "manifest.json");
  };
  // The mesh was made before the lines, and read by what comes after them.
  EXPECT_GT(used("torus/import-", "mesh.hdf"), used("torus/trace-", "lines.hdf"));
}

TEST_F(RunOptions, SaysWhereThereAreNoScriptsToWrite) {
  must("strake run -q");
  EXPECT_NE(must("strake submit --script-only -o jobs").find("nothing is stale"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(file("jobs")));
}

TEST_F(RunOptions, NamesTooLongForTheSystemAreRefused) {
  const std::string name(300, 'x');
  must_fail(kBadInput, "strake run --store " + name, "cannot be made");
  must("strake sample torus -o torus.ply --faces 500");
  must_fail(kBadInput, "strake remesh torus.ply -o out.obj --keep " + name, "cannot be made");
}

/// Two models of which one cannot be imported.
class Failure : public PipelineTest {
 protected:
  Failure() {
    put("bad.obj", "nothing of use\n");
    pipeline(
        "models: {z: {sample: {kind: torus, faces: 2000}}, bad: bad.obj}\n"
        "outputs: {mesh: '{model}.hdf'}\n");
  }
};

TEST_F(Failure, TellsWhatTheProgramSaidAndItsExitCode) {
  const Outcome outcome = run("strake run bad");
  EXPECT_EQ(outcome.exit_code, kBadInput);
  EXPECT_NE(outcome.err.find("strake-import: error: "), std::string::npos) << outcome.err;
  const std::size_t log = outcome.err.find("log: ");
  ASSERT_NE(log, std::string::npos) << outcome.err;
  const std::string path = outcome.err.substr(log + 5, outcome.err.find('\n', log) - log - 5);
  std::ifstream stream(path);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_NE(text.find("strake-import: error: "), std::string::npos) << path << text;
  EXPECT_NE(text.find("exit code 3"), std::string::npos) << text;
  EXPECT_EQ(names(steps_in(outcome.out), "failed (3)"), "bad import");
  EXPECT_EQ(steps_in(outcome.out)["bad tensor"], "not run");
}

TEST_F(Failure, StopsAndReturnsTheFailuresExitCode) {
  // Steps of the sound model that are not run any more come first in the plan.
  const Outcome outcome = run("strake run --jobs 2");
  EXPECT_EQ(outcome.exit_code, kBadInput) << outcome.err;
  EXPECT_EQ(steps_in(outcome.out)["z evaluate"], "not run");
}

TEST_F(Failure, IsNoResult) {
  run("strake run -q");
  const auto is_result = [&](const std::string& entry) {
    return fs::exists(file("store") / entry / "manifest.json");
  };
  const std::vector<std::string> all = entries();
  const std::string expected =
      std::to_string(std::count_if(all.begin(), all.end(), is_result)) + " results";
  EXPECT_NE(must("strake status").find(expected), std::string::npos) << expected;
  EXPECT_NE(must("strake gc --older-than 1d").find(expected), std::string::npos) << expected;
}

TEST_F(Failure, KeepGoingRunsWhatDoesNotDependOnIt) {
  const Outcome outcome = run("strake run --keep-going");
  EXPECT_EQ(outcome.exit_code, kBadInput);
  EXPECT_EQ(steps_in(outcome.out)["z evaluate"], "ran");
  EXPECT_EQ(steps_in(outcome.out)["bad tensor"], "not run");
}

TEST_F(Failure, AnOutputThatCannotBeWrittenFailsItsStepOnly) {
  put("out", "a file where a folder is needed\n");
  pipeline(
      "models: {z: {sample: {kind: torus, faces: 2000}}}\noutputs: {quads: 'out/{model}.obj'}\n");
  const Outcome outcome = run("strake run");
  EXPECT_EQ(outcome.exit_code, kBadInput);
  EXPECT_NE(outcome.err.find("out/z.obj"), std::string::npos) << outcome.err;
  fs::remove(file("out"));
  EXPECT_EQ(must("strake run --until mesh"), "wrote out/z.obj\n0 steps run, 7 in the store\n");
  EXPECT_TRUE(fs::exists(file("out/z.obj")));
}

/// A store with results of two seeds.
class Collection : public PipelineTest {
 protected:
  Collection() {
    pipeline("models: {torus: {sample: {kind: torus, faces: 2000}}}\n");
    must("strake run -q --set trace.seed=7");
    must("strake run -q");
    EXPECT_EQ(entries().size(), 10u);
  }
};

TEST_F(Collection, StatusSaysWhatIsReadyAndWhatIsStale) {
  const std::string ready = must("strake status");
  EXPECT_EQ(ready.find("stale"), std::string::npos) << ready;
  EXPECT_NE(ready.find("10 results"), std::string::npos) << ready;
  const std::string stale = must("strake status --set trace.seed=8 --steps");
  EXPECT_NE(stale.find("ready    torus smooth: "), std::string::npos) << stale;
  EXPECT_NE(stale.find("stale    torus trace: seed "), std::string::npos) << stale;
}

TEST_F(Collection, UnreachableGoes) {
  const auto before = snapshot();
  EXPECT_NE(must("strake gc --unreachable --dry-run").find("7 results left"), std::string::npos);
  EXPECT_EQ(snapshot(), before);
  EXPECT_NE(must("strake gc --unreachable").find("7 results left"), std::string::npos);
  EXPECT_EQ(entries().size(), 7u);
  EXPECT_EQ(must("strake run"), "0 steps run, 7 in the store\n");
}

TEST_F(Collection, WhatMayBeFoundAgainIsReachable) {
  fs::remove_all(artifact("torus/import-", "mesh.hdf").parent_path());
  must("strake gc --unreachable");
  const auto steps = run_steps();
  EXPECT_EQ(names(steps, "ran"), "torus import");
}

TEST_F(Collection, LongUnusedGoes) {
  must("strake gc --older-than 1h");
  EXPECT_EQ(entries().size(), 10u);
  const fs::path lines = artifact("torus/sample-", "sample.ply");
  for (const auto& each : fs::directory_iterator(lines.parent_path())) {
    fs::last_write_time(each, fs::last_write_time(each) - std::chrono::hours(3));
  }
  must("strake gc --older-than 2h");
  EXPECT_EQ(entries().size(), 9u);
  EXPECT_FALSE(fs::exists(lines));
}

TEST_F(Collection, WhatWasUsedLastStays) {
  must("strake run -q --set trace.seed=7");
  must("strake gc --max-size 600kB");
  const auto left = entries();
  EXPECT_LT(left.size(), 10u);
  EXPECT_GT(left.size(), 0u);
  std::uintmax_t size = 0;
  for (const std::string& entry : left) {
    for (const auto& each : fs::directory_iterator(file("store") / entry)) size += each.file_size();
  }
  EXPECT_LE(size, 600000u);
  must("strake gc --max-size 0");
  EXPECT_EQ(entries().size(), 0u);
  must_fail(kUsage, "strake gc", "say what may go");
  must_fail(kUsage, "strake gc --unreachable torus", "torus");  // or all other models would go
  must_fail(kUsage, "strake gc --max-size lots", "10GB");
  must_fail(kUsage, "strake gc --max-size 10", "10GB, a number and a unit");
  must_fail(kUsage, "strake gc --older-than 30", "30d, a number and a unit");
}

TEST_F(Collection, FoldersOfRunsThatBeginStay) {
  const fs::path run = file("store") / ".runs" / "begun";
  fs::create_directories(run);  // as it is before there is anything inside
  must("strake gc --unreachable");
  EXPECT_TRUE(fs::exists(run));
  fs::last_write_time(run, fs::last_write_time(run) - std::chrono::hours(8 * 24));
  must("strake gc --unreachable");
  EXPECT_FALSE(fs::exists(run));
}

TEST_F(Collection, RunsOfAClusterThatHaveNotEndedStayLonger) {
  const fs::path runs = file("store") / ".runs";
  const auto age = [&](int days) {
    for (const auto& run : fs::directory_iterator(runs)) {
      const auto then = fs::file_time_type::clock::now() - std::chrono::hours(days * 24);
      fs::last_write_time(run.path() / "outcomes", then);
    }
  };
  const fs::path waiting = fs::directory_iterator(runs)->path();
  const fs::path killed = runs / "killed";
  fs::remove(fs::directory_iterator(waiting / "outcomes")->path());
  fs::copy(waiting, killed, fs::copy_options::recursive);
  fs::remove(waiting / "build.ninja");  // as of a cluster
  age(8);
  must("strake gc --unreachable");
  EXPECT_TRUE(fs::exists(waiting));
  EXPECT_FALSE(fs::exists(killed));
  EXPECT_EQ(std::distance(fs::directory_iterator(runs), {}), 1);
  age(91);
  must("strake gc --unreachable");
  EXPECT_FALSE(fs::exists(waiting));
}

/// More records of runs than are kept, all older than those of today.
class ManyRuns : public PipelineTest {
 protected:
  static constexpr int kMade = 60;
  static constexpr int kKept = 50;

  ManyRuns() : runs_(file("store") / ".runs") {
    pipeline("models: {torus: {sample: {kind: torus, faces: 2000}}}\n");
    must("strake run -q --until import");
    const fs::path first = fs::directory_iterator(runs_)->path();
    for (int n = 0; n < kMade; ++n) {
      const fs::path copy = runs_ / ("earlier-" + std::to_string(n));
      fs::copy(first, copy, fs::copy_options::recursive);
      age(copy, 2 + n);
    }
  }
  static void age(const fs::path& run, int hours) {
    fs::last_write_time(run / "outcomes",
                        fs::file_time_type::clock::now() - std::chrono::hours(hours));
  }
  [[nodiscard]] std::ptrdiff_t left() const {
    return std::distance(fs::directory_iterator(runs_), {});
  }
  [[nodiscard]] fs::path earlier(int n) const { return runs_ / ("earlier-" + std::to_string(n)); }

  fs::path runs_;
};

TEST_F(ManyRuns, TheNewestStay) {
  must("strake run");  // makes the rest of the results: a record more
  EXPECT_EQ(left(), kKept);
  EXPECT_TRUE(fs::exists(earlier(kKept - 3)));
  EXPECT_FALSE(fs::exists(earlier(kKept - 2)));
  must("strake run --dry-run");
  must("strake run");
  EXPECT_EQ(left(), kKept);
}

TEST_F(ManyRuns, WhatMayGoOnStays) {
  const auto lose_an_outcome = [&](int n) {
    fs::remove(fs::directory_iterator(earlier(n) / "outcomes")->path());
    age(earlier(n), 2 + n);
  };
  const FolderLock going_on(earlier(59));
  lose_an_outcome(58);
  fs::remove(earlier(58) / "build.ninja");  // as of a cluster, whose jobs may wait
  lose_an_outcome(57);                      // as of a run that was killed
  age(earlier(56), 0);                      // one of the newest, then
  must("strake run");
  EXPECT_TRUE(fs::exists(earlier(59)));
  EXPECT_TRUE(fs::exists(earlier(58)));
  EXPECT_FALSE(fs::exists(earlier(57)));
  EXPECT_TRUE(fs::exists(earlier(56)));
  EXPECT_EQ(left(), kKept + 2);
}

TEST_F(Collection, NothingGoesFromAFolderThatIsNoStore) {
  fs::create_directories(file("photos/2024/summer-0123456789abcdef"));
  put("pipeline.yaml",
      "version: 1\nstore: photos\nstages: {import: {}}\n"
      "models: {torus: {sample: {kind: torus, faces: 2000}}}\n");
  must_fail(kBadInput, "strake gc --unreachable", "is no store");
  EXPECT_TRUE(fs::exists(file("photos/2024/summer-0123456789abcdef")));
}

/// As from cron, for a store that several pipelines share.
TEST_F(Collection, AStoreThatIsNamedNeedsNoPipeline) {
  fs::remove(file("pipeline.yaml"));
  const std::string said = must("strake gc --store store --older-than 1h");
  EXPECT_NE(said.find("10 results left"), std::string::npos) << said;
  must_fail(kBadInput, "strake gc --store stroe --older-than 1h",
            "stroe': there is no such folder");
  must_fail(kUsage, "strake gc --store 'a\nb' --older-than 1h", "control characters");
  must_fail(kBadInput, "strake gc --store store --unreachable", "pipeline.yaml");
  must_fail(kBadInput, "strake gc --older-than 1h", "pipeline.yaml");
  EXPECT_EQ(entries().size(), 10u);
  must("strake gc --store store --max-size 0");
  EXPECT_EQ(entries().size(), 0u);
}

TEST_F(Collection, AStoreWithoutItsFileGetsOneWhereResultsAreFound) {
  fs::remove(file("store/strake-store.json"));
  must_fail(kBadInput, "strake gc --max-size 0", "'strake run' find results there");
  must("strake run --dry-run");
  EXPECT_FALSE(fs::exists(file("store/strake-store.json")));
  EXPECT_EQ(must("strake run"), "0 steps run, 7 in the store\n");
  must("strake gc --older-than 1h");
  put("store/strake-store.json", "");
  must_fail(kBadInput, "strake run", "strake-store.json' is damaged");
}

TEST_F(Collection, WhatIsBeingMadeStays) {
  const std::string entry = entries().front();
  const FolderLock maker(file("store") / entry);
  const std::string said = must("strake gc --max-size 0");
  EXPECT_NE(said.find("kept     " + entry), std::string::npos) << said;
  EXPECT_EQ(entries(), std::vector<std::string>{entry});
}

}  // namespace
}  // namespace strake::pipeline_test
