#include "common/artifact/store/store.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <memory>

#include "common/artifact/digest.h"
#include "common/artifact/store/folder_lock.h"
#include "common/artifact/store/known_digests.h"
#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

class StoreTest : public testing::Test {
 protected:
  StoreTest() {
    fs::create_directories(folder_);
    store_.prepare();
  }
  ~StoreTest() override { fs::remove_all(folder_); }

  static std::string bytes(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void put(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }
  /// Adds an entry with an artifact of this text.
  Entry add(const std::string& text = "whole") const {
    fs::create_directories(store_.folder(name_));
    Entry entry;
    entry.file = store_.folder(name_) / "lines.hdf";
    put(entry.file, text);
    entry.digest = entry.content = digest_file(entry.file);
    entry.provenance = {"trace", 2, {{"seed", "7", false}}, {{"mesh", "0123"}}};
    store_.add(name_, entry);
    return entry;
  }
  [[nodiscard]] fs::path manifest() const { return store_.folder(name_) / "manifest.json"; }
  /// What `find` says is wrong; "" where it finds the entry, "absent" where there is none.
  [[nodiscard]] std::string damage(Store::Check check = Store::Check::stamp) const {
    std::string said;
    const bool found = store_.find(name_, check, &said).has_value();
    EXPECT_TRUE(!found || said.empty());
    return found ? "" : said.empty() ? "absent" : said;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("strake-store-" + std::to_string(::getpid()));
  Store store_{folder_ / "store"};
  EntryName name_{"torus", "trace", "0123456789abcdef0123456789abcdef"};
};

TEST_F(StoreTest, FindsWhatWasAdded) {
  EXPECT_EQ(damage(), "absent");
  const Entry added = add();
  const std::optional<Entry> found = store_.find(name_, Store::Check::content);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->key, name_.key);
  EXPECT_EQ(found->file, added.file);
  EXPECT_EQ(found->digest, added.digest);
  EXPECT_EQ(found->content, added.content);
  EXPECT_EQ(found->provenance, added.provenance);
  EXPECT_EQ(found->stamp, added.stamp);
}

TEST_F(StoreTest, WithoutManifestThereIsNoEntry) {
  add();
  fs::remove(manifest());
  EXPECT_EQ(damage(), "absent");
}

TEST_F(StoreTest, EveryFlippedBitOfAManifestIsSeen) {
  add();
  const std::string whole = bytes(manifest());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string flipped = whole;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << i % 7));
    put(manifest(), flipped);
    const std::optional<Entry> found = store_.find(name_, Store::Check::stamp);
    // White space between the values says nothing.
    EXPECT_TRUE(!found || whole[i] == ' ' || whole[i] == '\n') << i << whole;
  }
}

TEST_F(StoreTest, TruncatedAndForeignManifestsAreSeen) {
  add();
  const std::string whole = bytes(manifest());
  for (std::size_t size = 0; size + 2 < whole.size(); size += 7) {
    put(manifest(), whole.substr(0, size));
    EXPECT_NE(damage().find("manifest"), std::string::npos) << size;
  }
  for (const char* text : {"[]", "7", "{}", "null", "{\"seal\": 3}", "\xff\xfe"}) {
    put(manifest(), text);
    EXPECT_NE(damage().find("manifest"), std::string::npos) << text;
  }
  put(manifest(), whole);
  name_.key.back() = '0';
  EXPECT_NE(damage().find("another entry"), std::string::npos);
}

TEST_F(StoreTest, DamagedArtifactsAreSeen) {
  const Entry entry = add();
  put(entry.file, "whol");
  EXPECT_EQ(damage(), "lines.hdf has 4 bytes instead of 5");
  const auto time = fs::last_write_time(entry.file);
  put(entry.file, "whule");
  fs::last_write_time(entry.file, time);
  EXPECT_EQ(damage(), "lines.hdf has other bytes than recorded");
  fs::remove(entry.file);
  EXPECT_EQ(damage(), "lines.hdf is missing");
  fs::create_directory(entry.file);
  EXPECT_EQ(damage(), "lines.hdf is missing");
}

TEST_F(StoreTest, RemembersThatACopyIsWhole) {
  const Entry entry = add();
  put(entry.file, "whole");  // other stamps, equal bytes
  const std::string before = bytes(manifest());
  const Store looker(store_.root(), Store::Access::look_only);
  EXPECT_TRUE(looker.find(name_, Store::Check::stamp));
  EXPECT_EQ(bytes(manifest()), before);
  const std::optional<Entry> found = store_.find(name_, Store::Check::stamp);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->stamp, stamp_of(entry.file));
  EXPECT_NE(bytes(manifest()), before);
}

TEST_F(StoreTest, WithdrawsWhatIsDamagedOnly) {
  const Entry entry = add();
  store_.withdraw_if_damaged(name_);
  EXPECT_EQ(damage(), "");
  put(entry.file, "whule");
  {
    const FolderLock maker(store_.folder(name_));
    store_.withdraw_if_damaged(name_);
    EXPECT_TRUE(fs::exists(manifest())) << "somebody is making it anew";
  }
  store_.withdraw_if_damaged(name_);
  EXPECT_EQ(damage(), "absent");
}

TEST_F(StoreTest, RemovesEntriesButNotUnderTheirMaker) {
  add();
  {
    const FolderLock maker(store_.folder(name_));
    ASSERT_TRUE(maker.is_held());
    EXPECT_FALSE(store_.remove(name_.folder()));
    EXPECT_EQ(damage(), "");
  }
  EXPECT_TRUE(store_.remove(name_.folder()));
  EXPECT_EQ(damage(), "absent");
  EXPECT_FALSE(fs::exists(store_.root() / "torus")) << "the folder of the model is empty";
  EXPECT_TRUE(fs::is_empty(store_.side_folder("trash")));
}

TEST_F(StoreTest, ListsEntriesOfAllModelsOrOne) {
  add();
  name_.model = "sphere";
  add();
  fs::create_directories(store_.root() / "sphere" / "mesh-0000000000000000");  // being made
  ASSERT_EQ(store_.list().size(), 3u);
  EXPECT_EQ(store_.list()[0].folder, "sphere/mesh-0000000000000000");
  EXPECT_FALSE(store_.list()[0].entry);
  EXPECT_EQ(store_.list("torus").size(), 1u);
  EXPECT_EQ(store_.list("missing").size(), 0u);
  EXPECT_GT(store_.list("torus")[0].bytes, 5);
}

TEST_F(StoreTest, ListsNothingElse) {
  for (const char* name : {"2024", "mesh-0000", "-0123456789abcdef", "mesh-0123456789abcdeg"}) {
    fs::create_directories(store_.root() / "photos" / name);
  }
  EXPECT_EQ(store_.list().size(), 0u);
}

TEST_F(StoreTest, OtherFoldersAreToldFromStores) {
  store_.require_own();
  Store(folder_ / "missing").require_own();
  EXPECT_THROW(Store(folder_).require_own(), InputError);
}

TEST_F(StoreTest, OtherFormatsAreRefused) {
  store_.check_format();
  for (const char* text : {"{\"format\": 2}", "{}", "garbage", "", "{\"format\": \"1\"}"}) {
    put(store_.root() / "strake-store.json", text);
    EXPECT_THROW(store_.check_format(), InputError) << text;
  }
}

TEST_F(StoreTest, AStoreThatCannotBeMadeIsNamed) {
  put(folder_ / "file", "");
  EXPECT_THROW(Store(folder_ / "file").prepare(), InputError);
  EXPECT_THROW(Store(folder_ / "file" / "below").prepare(), InputError);
}

TEST_F(StoreTest, OneLockAnEntry) {
  const fs::path entry = store_.folder(name_);
  auto first = std::make_unique<FolderLock>(entry);
  EXPECT_TRUE(first->is_held());
  EXPECT_FALSE(FolderLock(entry).is_held());
  const pid_t child = ::fork();
  if (child == 0) ::_exit(FolderLock(entry).is_held() ? 1 : 0);
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0) << "another process has it too";
  first.reset();
  EXPECT_TRUE(FolderLock(entry).is_held());
}

TEST_F(StoreTest, LocksSurviveRemovalsAtAnyMoment) {
  // One process makes and another removes the same entry over and over: neither may fail.
  const pid_t remover = ::fork();
  if (remover == 0) {
    try {
      for (;;) (void)store_.remove(name_.folder());
    } catch (const std::exception&) {
      ::_exit(1);
    }
  }
  int held = 0;
  for (int round = 0; round < 3000; ++round) {
    std::unique_ptr<FolderLock> lock;
    EXPECT_NO_THROW(lock = std::make_unique<FolderLock>(store_.folder(name_))) << round;
    if (!lock) break;  // the remover must end all the same
    if (!lock->is_held()) continue;
    ++held;
    EXPECT_TRUE(fs::exists(store_.folder(name_) / "lock"));
  }
  EXPECT_EQ(::waitpid(remover, nullptr, WNOHANG), 0) << "the remover has failed";
  ::kill(remover, SIGKILL);
  ::waitpid(remover, nullptr, 0);
  EXPECT_GT(held, 0);
}

TEST_F(StoreTest, WhatIsLeftInTheTrashIsInNobodysWay) {
  add();
  const fs::path entry = name_.folder();
  const fs::path grave =
      store_.side_folder("trash") / (entry.parent_path().string() + "-" +
                                     entry.filename().string() + "-" + std::to_string(::getpid()));
  fs::create_directories(grave);
  put(grave / "lock", "");
  EXPECT_TRUE(store_.remove(name_.folder()));
  EXPECT_FALSE(fs::exists(store_.folder(name_)));
}

TEST_F(StoreTest, DigestsAreRememberedAsLongAsTheStampsStay) {
  put(folder_ / "model", "one");
  KnownDigests digests(store_);
  EXPECT_EQ(digests.digest(folder_ / "model"), digest_text("one"));
  put(folder_ / "model", "two");
  EXPECT_EQ(digests.digest(folder_ / "model"), digest_text("two")) << "too fresh to be trusted";
  EXPECT_EQ(digests.find(folder_ / "missing"), std::nullopt);
  EXPECT_THROW((void)digests.digest(folder_ / "missing"), InputError);
}

TEST_F(StoreTest, WhoOnlyLooksWritesNothing) {
  add();
  const Store looker(store_.root(), Store::Access::look_only);
  const std::optional<FileStamp> before = stamp_of(manifest());
  looker.touch(name_);
  KnownDigests digests(looker);
  EXPECT_EQ(digests.digest("/proc/self/exe").size(), 32u);
  EXPECT_EQ(stamp_of(manifest()), before);
  EXPECT_TRUE(fs::is_empty(store_.side_folder("digests")));
}

TEST(StoreKey, DependsOnAllThatMakesAResult) {
  const Provenance base = {"trace", 2, {{"seed", "7", false}}, {{"mesh", "0123"}}};
  const std::string key = key_of(base, ".hdf");
  Provenance other = base;
  other.stage = "mesh";
  EXPECT_NE(key_of(other, ".hdf"), key);
  other = base;
  other.stage_version = 3;
  EXPECT_NE(key_of(other, ".hdf"), key);
  other = base;
  other.options[0].value = "8";
  EXPECT_NE(key_of(other, ".hdf"), key);
  other = base;
  other.inputs[0].digest = "0124";
  EXPECT_NE(key_of(other, ".hdf"), key);
  EXPECT_NE(key_of(base, ".obj"), key);
  EXPECT_EQ(key_of(base, ".hdf"), key);
}

}  // namespace
}  // namespace strake
