#include "strake/run/memory_gate.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMega = 1 << 20;

/// Thrown by a waiting share that has waited long enough for the test.
struct WaitedInVain : std::runtime_error {
  WaitedInVain() : std::runtime_error("no share") {}
};

class MemoryShareTest : public testing::Test {
 protected:
  ~MemoryShareTest() override { fs::remove(file_); }

  [[nodiscard]] std::unique_ptr<MemoryShare> take(std::int64_t total, std::int64_t share) const {
    int rounds = 0;
    return std::make_unique<MemoryShare>(file_, total, share, [&] {
      if (++rounds > 2) throw WaitedInVain();
    });
  }

  fs::path file_ = fs::path(testing::TempDir()) / ("strake-memory-" + std::to_string(::getpid()));
};

TEST_F(MemoryShareTest, SharesThatFitAreGivenAtOnce) {
  const auto first = take(160 * kMega, 80 * kMega);
  const auto second = take(160 * kMega, 64 * kMega);
  EXPECT_THROW((void)take(160 * kMega, 32 * kMega), WaitedInVain);
  const auto third = take(160 * kMega, 16 * kMega);
}

TEST_F(MemoryShareTest, AShareThatIsGivenBackIsFree) {
  auto first = take(160 * kMega, 160 * kMega);
  EXPECT_THROW((void)take(160 * kMega, 16 * kMega), WaitedInVain);
  first.reset();
  EXPECT_NO_THROW((void)take(160 * kMega, 160 * kMega));
}

TEST_F(MemoryShareTest, WhoGivesUpLeavesNothingLocked) {
  {
    const auto first = take(160 * kMega, 96 * kMega);
    EXPECT_THROW((void)take(160 * kMega, 96 * kMega), WaitedInVain);
    EXPECT_NO_THROW((void)take(160 * kMega, 64 * kMega));
  }
  EXPECT_NO_THROW((void)take(160 * kMega, 160 * kMega));
}

TEST_F(MemoryShareTest, MoreThanThereIsMeansAll) {
  const auto all = take(32 * kMega, 1000 * kMega);
  EXPECT_THROW((void)take(32 * kMega, 1), WaitedInVain);
}

TEST_F(MemoryShareTest, HugeAndTinyTotalsWork) {
  EXPECT_NO_THROW((void)take(std::int64_t{1} << 59, 100 * kMega));
  EXPECT_NO_THROW((void)take(1, 100 * kMega));
}

TEST_F(MemoryShareTest, NeverMoreAtOnceThanThereIs) {
  std::atomic<int> used = 0;
  std::atomic<int> most = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 6; ++t) {
    threads.emplace_back([&, share = 1 + t % 3] {
      for (int round = 0; round < 3; ++round) {
        const MemoryShare mine(file_, 64 * kMega, share * 16 * kMega, [] {});
        const int now = used += share;
        for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) continue;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        used -= share;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_LE(most, 4);
  EXPECT_GE(most, 2) << "shares that fit together are given together";
}

TEST_F(MemoryShareTest, AFolderThatIsMissingIsNamed) {
  EXPECT_THROW(MemoryShare(file_ / "missing", kMega, kMega, [] {}), InputError);
}

}  // namespace
}  // namespace strake
