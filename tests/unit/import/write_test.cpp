#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <iterator>
#include <limits>

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/artifact/meshfile/mesh_writer.h"
#include "common/core/error.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

class WriteTest : public testing::TestWithParam<const char*> {
 protected:
  WriteTest() : path_(fs::path(testing::TempDir()) / "strake_write_test") {
    path_.replace_extension(GetParam());
    fs::remove(path_);
  }
  ~WriteTest() override { fs::remove(path_); }

  [[nodiscard]] PolyMesh reread() const {
    ReadReport report;
    PolyMesh mesh = read_mesh(path_, report);
    EXPECT_TRUE(report.warnings().empty());
    return mesh;
  }

  fs::path path_;
};

TEST_P(WriteTest, ReadsBackWithoutAnyChange) {
  PolyMesh mesh = shapes::torus(7, 5);
  mesh.add_face(std::vector<Index>{0, 1, 2});
  mesh.add_face(std::vector<Index>{0, 1, 2, 9, 8});
  mesh.positions[0] = Vec3(1.0 / 3, std::numeric_limits<double>::denorm_min(), -0.0);
  mesh.positions[1] = Vec3(std::numeric_limits<double>::max(), -1e-17, 123456789.123456789);
  write_mesh(path_, mesh);
  const PolyMesh again = reread();
  EXPECT_EQ(again.positions, mesh.positions);
  EXPECT_EQ(again.offsets, mesh.offsets);
  EXPECT_EQ(again.corners, mesh.corners);
}

TEST_P(WriteTest, FacesOfManyCorners) {
  PolyMesh mesh;
  std::vector<Index> face;
  for (Index i = 0; i < 300; ++i) {
    mesh.positions.emplace_back(std::cos(i), std::sin(i), i);
    face.push_back(i);
  }
  mesh.add_face(face);
  write_mesh(path_, mesh);
  EXPECT_EQ(reread().corners, mesh.corners);
}

INSTANTIATE_TEST_SUITE_P(Formats, WriteTest, testing::Values(".obj", ".ply", ".off", ".OBJ"));

TEST(Write, RefusesUnknownExtensionsAndMissingFolders) {
  const PolyMesh mesh = shapes::cube();
  EXPECT_THROW(write_mesh("mesh.docx", mesh), UsageError);
  EXPECT_THROW(write_mesh("no/such/folder/mesh.obj", mesh), InputError);
}

TEST(Write, FailureIsAnErrorAndLeavesTheOldFile) {
  const fs::path folder = fs::path(testing::TempDir()) / "strake_write_failure";
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_mesh(folder / "mesh.ply", shapes::cube());
  // The system refuses to let files grow beyond this, as a full disk would.
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 1000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_mesh(folder / "mesh.ply", shapes::torus(20, 20)), InputError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  ReadReport report;
  EXPECT_EQ(read_mesh(folder / "mesh.ply", report).face_count(), 6);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace strake
