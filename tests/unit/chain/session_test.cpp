#include "strake/chain/session.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace strake {
namespace {

class Silence : public StageObserver {
 public:
  void report(std::string_view /*phase*/, double /*fraction*/) override {}
};

/// A stage that takes a tensor field, and notes where its numbers lie.
Stage taking_stage(const void*& place) {
  Stage stage;
  stage.name = "take";
  stage.inputs = {{"tensor", PortKind::tensor, ""}};
  stage.run = [&place](Inputs& inputs, Observer& /*observer*/) {
    const TensorField field = inputs.take<TensorField>("tensor");
    place = field.tensor.data();
    return StageResult{};
  };
  return stage;
}

/// A session with a tensor field.
class SessionTest : public testing::Test {
 protected:
  SessionTest() {
    TensorField field;
    field.tensor.assign(100, {1, 2, 3, 4, 5, 6});
    session_.provide("tensor", std::move(field), "here", "");
    first_ = session_.get<TensorField>("tensor").tensor.data();
  }

  Silence silence_;
  Session session_{silence_};
  const void* first_ = nullptr;
  const void* taken_ = nullptr;
};

TEST_F(SessionTest, AStageUsesTheMemoryOfAnInputThatNobodyNeedsAfterIt) {
  session_.run(taking_stage(taken_), "tensor");
  EXPECT_EQ(taken_, first_);
  EXPECT_FALSE(session_.has("tensor"));
}

TEST_F(SessionTest, AStageLeavesTheInputsThatOthersNeed) {
  session_.run(taking_stage(taken_));
  EXPECT_NE(taken_, first_);
  EXPECT_EQ(session_.get<TensorField>("tensor").tensor.data(), first_);
}

TEST_F(SessionTest, SnapshotsKeepWhatAStageUsesUp) {
  const Session before = session_;
  session_.run(taking_stage(taken_), "tensor");
  EXPECT_NE(taken_, first_);
  EXPECT_EQ(before.get<TensorField>("tensor").tensor.size(), 100u);
}

class LineKeeper : public StageObserver {
 public:
  void report(std::string_view /*phase*/, double /*fraction*/) override {}
  void say(const std::string& message) override { said.push_back(message); }
  std::vector<std::string> said;
};

// A search runs stages many times, on copies of a session.
TEST(SessionWarnings, AreSaidOnce) {
  LineKeeper listener;
  Session session(listener);
  Stage stage;
  stage.name = "warn";
  std::string warning = "thin";
  stage.run = [&warning](Inputs& /*inputs*/, Observer& /*observer*/) {
    StageResult result;
    result.report.warn(warning);
    return result;
  };
  session.run(stage);
  Session copy = session;
  copy.run(stage);
  session.run(stage);
  warning = "bent";
  session.run(stage);
  EXPECT_EQ(listener.said,
            (std::vector<std::string>{"warn: warning: thin", "warn: warning: bent"}));
}

// Each attempt has other numbers; only those of the one that is taken matter.
TEST(SessionWarnings, AreThoseOfTheAttemptThatIsTaken) {
  LineKeeper listener;
  Session session(listener);
  Stage stage;
  stage.name = "warn";
  int components = 3;
  stage.run = [&components](Inputs& /*inputs*/, Observer& /*observer*/) {
    StageResult result;
    result.report.warn(std::to_string(components) + " component(s)");
    return result;
  };
  session.hold_warnings_of(stage);
  session.run(stage);
  const Session taken = session;
  components = 5;
  session.run(stage);
  session = taken;
  EXPECT_TRUE(listener.said.empty());
  session.say_held(stage);
  EXPECT_EQ(listener.said, std::vector<std::string>{"warn: warning: 3 component(s)"});
}

}  // namespace
}  // namespace strake
