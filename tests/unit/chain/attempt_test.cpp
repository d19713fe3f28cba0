#include "strake/chain/attempt.h"

#include <gtest/gtest.h>

#include <string_view>

#include "common/core/error.h"
#include "common/core/tolerance_error.h"

namespace strake {
namespace {

class Silence : public StageObserver {
 public:
  void report(std::string_view /*phase*/, double /*fraction*/) override {}
};

/// Attempts that leave so many crossing faces one after the other, the first one included.
class Attempts {
 public:
  explicit Attempts(std::vector<std::size_t> left) : left_(std::move(left)) {}

  /// \param faces  of each
  Attempt part(Index faces, int patience = 5) {
    return part_faces(
        next(session_), faces, patience,
        [&](Session session, const std::vector<Vec3>& places) {
          EXPECT_EQ(places.size(), left_.at(made_ - 1));
          return next(std::move(session));
        },
        [&](const Attempt& best) {
          asked_of_.push_back(best.places.size());
          return gives_up_;
        },
        [&](Attempt& attempt) { kept_ = attempt.places.size(); });
  }
  /// From now on as soon as that is asked.
  void give_up() { gives_up_ = true; }
  /// Faces that cross in the attempts that it was asked of.
  [[nodiscard]] const std::vector<std::size_t>& asked_of() const { return asked_of_; }
  /// Those that were made again.
  [[nodiscard]] std::size_t again() const { return made_ - 1; }
  /// Faces that the attempt crosses in that was kept again; 0 where none was.
  [[nodiscard]] std::size_t kept() const { return kept_; }

 private:
  Attempt next(Session session) {
    const std::vector<Vec3> places(left_.at(made_), Vec3::Zero());
    ++made_;
    return {session, session, places, false};
  }

  Silence silence_;
  Session session_{silence_};
  std::vector<std::size_t> left_;
  std::size_t made_ = 0;
  std::size_t kept_ = 0;
  bool gives_up_ = false;
  std::vector<std::size_t> asked_of_;
};

TEST(PartFaces, EndsWhereNoFacesCross) {
  Attempts attempts({8, 3, 0});
  EXPECT_TRUE(attempts.part(100).places.empty());
  EXPECT_EQ(attempts.again(), 2u);
  EXPECT_EQ(attempts.kept(), 0u);
}

TEST(PartFaces, GoesOnForEightAttemptsThatHelp) {
  Attempts attempts({512, 256, 128, 64, 32, 16, 8, 4, 2, 1});
  EXPECT_EQ(attempts.part(10'000).places.size(), 2u);
  EXPECT_EQ(attempts.again(), 8u);
}

TEST(PartFaces, GivesUpAfterFiveThatDoNotAndKeepsTheBest) {
  Attempts attempts({80, 79, 78, 79, 77, 78, 0});
  EXPECT_EQ(attempts.part(10'000).places.size(), 77u);
  EXPECT_EQ(attempts.again(), 5u);
  EXPECT_EQ(attempts.kept(), 77u);
}

TEST(PartFaces, AsksOnceWhetherToGiveUpAfterTwoThatLeaveMoreThanHalf) {
  Attempts going_on({64, 60, 20, 19, 12, 0});
  EXPECT_TRUE(going_on.part(10'000).places.empty());
  EXPECT_EQ(going_on.asked_of(), std::vector<std::size_t>{19});
  Attempts giving_up({64, 60, 20, 19, 12, 0});
  giving_up.give_up();
  EXPECT_EQ(giving_up.part(10'000).places.size(), 19u);
  EXPECT_EQ(giving_up.again(), 3u);
  Attempts helping({64, 30, 12, 0});
  helping.part(10'000);
  EXPECT_TRUE(helping.asked_of().empty());
}

TEST(PartFaces, GivesUpAfterTwoInARowThatLeaveNoFewer) {
  Attempts attempts({8, 7, 9, 8, 0});
  EXPECT_EQ(attempts.part(1000).places.size(), 7u);
  EXPECT_EQ(attempts.again(), 3u);
  EXPECT_EQ(attempts.kept(), 7u);
}

TEST(PartFaces, TriesNothingWhereMostFacesCross) {
  Attempts attempts({301, 0});
  EXPECT_EQ(attempts.part(1000).places.size(), 301u);
  EXPECT_EQ(attempts.again(), 0u);
}

TEST(PartFaces, SoonGivesUpWhereManyFacesCross) {
  Attempts attempts({101, 100, 99, 98, 0});
  EXPECT_EQ(attempts.part(1000).places.size(), 99u);
  EXPECT_EQ(attempts.again(), 2u);
  Attempts helping({200, 90, 40, 15, 0});
  EXPECT_TRUE(helping.part(1000).places.empty());
}

TEST(PartFaces, HasThePatienceAskedFor) {
  Attempts attempts({8, 7, 9, 8, 0});
  EXPECT_EQ(attempts.part(100, 2).places.size(), 7u);
  EXPECT_EQ(attempts.again(), 2u);
}

/// Neither takes away what there is: a result that was proven is one.
TEST(PartFaces, KeepsTheBestWhereAnAttemptComesToNothing) {
  Silence silence;
  const Session session(silence);
  const Attempt first{session, session, std::vector<Vec3>(8, Vec3::Zero()), false};
  const auto after = [&](const Again& again) {
    std::size_t kept = 0;
    const Attempt best = part_faces(first, 100, 5, again, never_give_up,
                                    [&](Attempt& attempt) { kept = attempt.places.size(); });
    EXPECT_EQ(kept, 8u);
    return best.places.size();
  };
  EXPECT_EQ(after([](const Session&, const auto&) -> Attempt { throw ToleranceError("far", {}); }),
            8u);
  EXPECT_EQ(after([](const Session&, const auto&) -> Attempt { throw AlgorithmError("odd"); }), 8u);
}

TEST(PartFaces, GivesUpWhereNothingChangesAnyMore) {
  Attempts attempts({50, 60, 60, 0});
  EXPECT_EQ(attempts.part(1000).places.size(), 50u);
  EXPECT_EQ(attempts.again(), 2u);
  EXPECT_EQ(attempts.kept(), 50u);
}

TEST(PartFaces, MakesFewerAttemptsAtALargeResult) {
  Attempts at_two({64, 32, 16, 8});
  at_two.part(80000);
  EXPECT_EQ(at_two.again(), 2u);
  Attempts at_huge({64, 32, 16});
  at_huge.part(10000000);
  EXPECT_EQ(at_huge.again(), 1u);
}

TEST(PartFaces, TriesNothingWhereVeryManyCross) {
  Attempts attempts({1001, 0});
  EXPECT_EQ(attempts.part(100).places.size(), 1001u);
  EXPECT_EQ(attempts.again(), 0u);
}

}  // namespace
}  // namespace strake
