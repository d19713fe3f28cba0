#include <filesystem>
#include <string>

#include "tests/pipeline/run_program.h"

namespace strake::pipeline_test {
namespace {

namespace fs = std::filesystem;

/// Files that cannot be written. Rights are none to the superuser, who may run this.
class Unwritable : public ProgramTest {
 protected:
  Unwritable() {
    must("strake sample torus -o torus.ply --faces 500");
    fs::create_symlink("loop.obj", file("loop.obj"));
    fs::create_symlink("loop.json", file("loop.json"));
  }
};

TEST_F(Unwritable, IsToldBeforeTheWork) {
  const std::string loop = "Too many levels of symbolic links";
  must_fail(kBadInput, "strake remesh torus.ply -o loop.obj --keep kept", loop);
  must_fail(kBadInput, "strake remesh torus.ply -o out.obj --report loop.json --keep kept", loop);
  must_fail(kBadInput, "strake remesh none.ply -o loop.obj", loop);
  must_fail(kBadInput, "strake-import none.ply -o out.hdf --report /proc/none.json", "/proc/none");
  must_fail(kBadInput, "strake-import none.ply -o /proc/none.hdf", "/proc/none");
  must_fail(kBadInput, "strake report none -o /proc/none.html", "/proc/none");
  must_fail(kBadInput, "strake-render none.ply -o /proc/none.png", "/proc/none");
}

TEST_F(Unwritable, WhatIsThereStays) {
  put("out.obj", "mine");
  must_fail(kBadInput, "strake remesh none.ply -o out.obj", "none.ply");
  EXPECT_EQ(bytes("out.obj"), "mine");
}

TEST_F(Unwritable, LinksToWhatIsNotThereAreFollowed) {
  fs::create_directory(file("scratch"));
  fs::create_symlink("scratch/quads.obj", file("quads.obj"));
  fs::create_symlink("quads.obj", file("link.obj"));
  must("strake remesh torus.ply -q -o link.obj --vertices 200 --no-evaluate");
  EXPECT_TRUE(fs::is_symlink(file("link.obj")));
  EXPECT_TRUE(fs::is_symlink(file("quads.obj")));
  EXPECT_TRUE(fs::is_regular_file(file("scratch/quads.obj")));
}

/// On a disk with room for the output alone.
TEST_F(Unwritable, AReportTakesTheOutputWithIt) {
  put("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const std::string command = " remesh square.obj -q -o out.obj --vertices 9 --report report.json";
  const Outcome full =
      shell("sh -c 'trap \"\" XFSZ; ulimit -f 4; exec \"$@\"' - " STRAKE_BIN "/strake" + command);
  EXPECT_EQ(full.exit_code, kBadInput) << full.err;
  EXPECT_NE(full.err.find("report.json"), std::string::npos) << full.err;
  EXPECT_FALSE(fs::exists(file("out.obj")));
  EXPECT_FALSE(fs::exists(file("report.json")));
  must("strake" + command);
  EXPECT_LT(fs::file_size(file("out.obj")), 2048u) << "or the room is too little for it";
  EXPECT_TRUE(fs::exists(file("report.json")));
}

}  // namespace
}  // namespace strake::pipeline_test
