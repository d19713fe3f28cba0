#include "common/artifact/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <string>

#include "common/artifact/text_file.h"
#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  AtomicFileTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("strake_atomic_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~AtomicFileTest() override { fs::remove_all(folder_); }

  static void write(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }
  static std::string read(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
};

TEST_F(AtomicFileTest, AppearsOnlyWithTheCommit) {
  const fs::path target = folder_ / "out.bin";
  AtomicFile file(target);
  write(file.temporary(), "new");
  EXPECT_FALSE(fs::exists(target));
  EXPECT_TRUE(file.commit());
  EXPECT_EQ(read(target), "new");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, LeavesTheOldFileWithoutCommit) {
  const fs::path target = folder_ / "out.bin";
  write(target, "old");
  {
    AtomicFile file(target);
    write(file.temporary(), "half");
  }
  EXPECT_EQ(read(target), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, KeepsTheTimeStampOfEqualBytes) {
  const fs::path target = folder_ / "out.bin";
  write(target, "same");
  const auto before = fs::last_write_time(target) - std::chrono::hours(1);
  fs::last_write_time(target, before);
  AtomicFile file(target);
  write(file.temporary(), "same");
  EXPECT_FALSE(file.commit());
  EXPECT_EQ(fs::last_write_time(target), before);
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, WritesThroughALink) {
  write(folder_ / "real.bin", "old");
  fs::create_symlink("real.bin", folder_ / "link.bin");
  AtomicFile file(folder_ / "link.bin");
  write(file.temporary(), "new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.bin"));
  EXPECT_EQ(read(folder_ / "real.bin"), "new");
}

TEST_F(AtomicFileTest, WritesThroughLinksToWhatIsNotThere) {
  fs::create_directory(folder_ / "far");
  fs::create_symlink("far/second.bin", folder_ / "first.bin");
  fs::create_symlink(folder_ / "far" / "real.bin", folder_ / "far" / "second.bin");
  AtomicFile file(folder_ / "first.bin");
  write(file.temporary(), "new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder_ / "first.bin"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "far" / "second.bin"));
  EXPECT_EQ(read(folder_ / "far" / "real.bin"), "new");
}

TEST_F(AtomicFileTest, RefusesLinksInACircle) {
  fs::create_symlink("there.bin", folder_ / "here.bin");
  fs::create_symlink("here.bin", folder_ / "there.bin");
  EXPECT_THROW(AtomicFile{folder_ / "here.bin"}, InputError);
  EXPECT_EQ(entries(), 2);
}

TEST_F(AtomicFileTest, RefusesFoldersAndMissingFolders) {
  EXPECT_THROW(AtomicFile{folder_}, InputError);
  try {
    AtomicFile file(folder_ / "missing" / "out.bin");
    FAIL() << "a missing folder must be refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("missing"), std::string::npos) << error.what();
  }
}

TEST_F(AtomicFileTest, SaysThatItCannotBePutIntoPlace) {
  const fs::path target = folder_ / "out.bin";
  {
    AtomicFile file(target);
    write(file.temporary(), "new");
    fs::create_directory(target);  // somebody else takes the name
    EXPECT_THROW(file.commit(), InputError);
  }
  EXPECT_TRUE(fs::is_directory(target));
  EXPECT_EQ(entries(), 1);
}

/// In a process of its own: nobody writes any more after that.
TEST_F(AtomicFileTest, AbandoningRemovesWhatIsNotCommitted) {
  const fs::path target = folder_ / "out.bin";
  write(target, "old");
  EXPECT_EXIT(
      {
        AtomicFile file(target);
        write(file.temporary(), "new");
        AtomicFile::abandon_all();
        ::_exit(entries() == 1 ? 7 : 8);
      },
      testing::ExitedWithCode(7), "");
  EXPECT_EQ(read(target), "old");
}

TEST_F(AtomicFileTest, TwoWritersDoNotDisturbEachOther) {
  const fs::path target = folder_ / "out.bin";
  AtomicFile first(target);
  AtomicFile second(target);
  ASSERT_NE(first.temporary(), second.temporary());
  write(first.temporary(), "first");
  write(second.temporary(), "second");
  first.commit();
  second.commit();
  EXPECT_EQ(read(target), "second");
}

TEST_F(AtomicFileTest, TextIsReadWholeOrNotAtAll) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{65536}, std::size_t{200001}}) {
    std::string text(size, 'a');
    if (size > 0) text.back() = '\0';
    write(folder_ / "text", text);
    EXPECT_EQ(read_text(folder_ / "text"), text) << size;
  }
  EXPECT_THROW(read_text(folder_), InputError);
  EXPECT_THROW(read_text(folder_ / "none"), InputError);
}

}  // namespace
}  // namespace strake
