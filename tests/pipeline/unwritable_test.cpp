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

TEST_F(Unwritable, LinksToWhatIsNotThereAreFollowed) {
  fs::create_directory(file("scratch"));
  fs::create_symlink("scratch/quads.obj", file("quads.obj"));
  fs::create_symlink("quads.obj", file("link.obj"));
  must("strake remesh torus.ply -q -o link.obj --vertices 200 --no-evaluate");
  EXPECT_TRUE(fs::is_symlink(file("link.obj")));
  EXPECT_TRUE(fs::is_symlink(file("quads.obj")));
  EXPECT_TRUE(fs::is_regular_file(file("scratch/quads.obj")));
}

}  // namespace
}  // namespace strake::pipeline_test
