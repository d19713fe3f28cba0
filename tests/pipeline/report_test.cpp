#include <unistd.h>

#include <filesystem>

#include "tests/pipeline/run_program.h"

namespace strake::pipeline_test {
namespace {

namespace fs = std::filesystem;

class ReportCommand : public ProgramTest {
 protected:
  ReportCommand() {
    must("strake sample part -o part.ply --faces 3000");
    must("strake remesh part.ply -q -o part.obj --vertices 400 --keep run");
  }
};

TEST_F(ReportCommand, SaysWhatAFolderLacksAndWritesNothing) {
  must_fail(2, "strake report run -o report.pdf", "ends in .html");
  must_fail(3, "strake report nowhere -o report.html", "nowhere");
  fs::create_directory(file("empty"));
  must_fail(3, "strake report empty -o report.html", "no artifact of kind 'quads'");
  fs::copy_file(file("run/fitted.hdf"), file("empty/fitted.hdf"));
  must_fail(3, "strake report empty -o report.html", "no artifact of kind 'mesh'");
  // A mesh that the result was not made from.
  must("strake sample torus -o torus.ply --faces 1000");
  must("strake-import torus.ply -q -o empty/mesh.hdf");
  must_fail(4, "strake report empty -o report.html", "mesh");
  put("empty/evaluate.json", "{ no json");
  must_fail(3, "strake report empty -o report.html", "evaluate.json");
}

TEST_F(ReportCommand, RunsFromFoldersOfTheSameNameCanBeToldApart) {
  STRAKE_VIEWER_OR_SKIP();
  fs::create_directory(file("fine"));
  fs::copy(file("run"), file("fine/run"));
  must("strake report run fine/run -o report.html");
  const std::string page = bytes("report.html");
  EXPECT_NE(page.find("\"name\":\"run\""), std::string::npos);
  EXPECT_NE(page.find("\"name\":\"fine/run\""), std::string::npos);
}

TEST_F(ReportCommand, LeavesJsonOfOthersAlone) {
  STRAKE_VIEWER_OR_SKIP();
  must("strake report run -o alone.html");
  put("run/build.json", R"({"stage": 3, "result": "passed"})");
  put("run/tests.json", R"({"stage": "tests", "result": {"passed": 7}})");
  must("strake report run -o beside.html");
  EXPECT_EQ(bytes("beside.html"), bytes("alone.html"));
}

TEST_F(ReportCommand, AFolderThatCannotBeReadIsNamed) {
  // The superuser can read every folder, but for one without privileges.
  const std::string as_others =
      ::geteuid() == 0 ? "setpriv --bounding-set=-all --inh-caps=-all " : "";
  fs::permissions(file("run"), fs::perms::none);
  const Outcome refused = shell(as_others + STRAKE_BIN "/strake report run -o report.html");
  fs::permissions(file("run"), fs::perms::owner_all);
  EXPECT_EQ(refused.exit_code, kBadInput) << refused.err;
  EXPECT_NE(refused.err.find("folder 'run' cannot be read"), std::string::npos) << refused.err;
}

TEST_F(ReportCommand, TwoResultsInAFolderAreOneTooMany) {
  must("strake-trace run/mesh.hdf run/field.hdf -q -o other-lines.hdf --vertices 200");
  must("strake-mesh run/mesh.hdf other-lines.hdf -q -o other.hdf");
  must("strake-fit run/mesh.hdf other.hdf -q -o run/other.hdf");
  fs::remove(file("run/evaluate.json"));  // which says what the result is
  must_fail(3, "strake report run -o report.html", "several results");
}

TEST_F(ReportCommand, TakesTheLastResultOfEveryGoal) {
  STRAKE_VIEWER_OR_SKIP();
  for (const std::string goal : {"", "--tolerance 0.3%", "--tolerance 0.3% --no-evaluate"}) {
    fs::remove_all(file("goal"));
    must("strake remesh part.ply -q -o part.obj --keep goal " + goal);
    must("strake report goal -o goal.html");
    const std::string vertices = "\n" + bytes("part.obj");
    std::size_t count = 0;
    for (std::size_t at = 0; (at = vertices.find("\nv ", at)) != std::string::npos; ++at) ++count;
    EXPECT_NE(bytes("goal.html").find("\"result\":{\"vertices\":" + std::to_string(count) + ","),
              std::string::npos)
        << goal;
  }
}

TEST_F(ReportCommand, IsTheSameForAnyNumberOfThreads) {
  STRAKE_VIEWER_OR_SKIP();
  must("strake report run -o one.html --threads 1");
  must("strake report run -o three.html --threads 3");
  EXPECT_EQ(bytes("one.html"), bytes("three.html"));
}

TEST_F(ReportCommand, TakesFilesOfAnyNameAndDoesWithoutTheRest) {
  STRAKE_VIEWER_OR_SKIP();
  fs::create_directory(file("own"));
  fs::copy_file(file("run/mesh.hdf"), file("own/the-input.hdf"));
  fs::copy_file(file("run/fitted.hdf"), file("own/the-output.hdf"));
  must("strake report own -o own.html");
  EXPECT_NE(bytes("own.html").find("\"feature-angle\":{"), std::string::npos);  // from the artifact
  must("strake report own run -o report.html");
  const std::string page = bytes("report.html");
  EXPECT_NE(page.find("no artifact of kind 'field'"), std::string::npos);
  EXPECT_NE(page.find("\"name\":\"own\""), std::string::npos);
  EXPECT_NE(page.find("\"name\":\"run\""), std::string::npos);
  EXPECT_EQ(page.find("%STRAKE_"), std::string::npos);
  // Nothing is fetched from anywhere: no link, no source, no import but of data.
  for (const char* fetch : {"<link", " src=\"http", "@import", "url(http"}) {
    EXPECT_EQ(page.find(fetch), std::string::npos) << fetch;
  }
}

}  // namespace
}  // namespace strake::pipeline_test
