// SPDX-License-Identifier: Apache-2.0
// What MoveIt attached before it was asked, and what it publishes meanwhile.
#include "live_scene.hpp"

#include <io/live/scene_question.hpp>
#include <io/ros/moveit_messages.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t patience = io::SceneQuestion::patience;

TEST(SceneQuestion, IsAskedAgainIfTheAnswerIsLostOrTheClockWasSetBack) {
  io::SceneQuestion question;
  EXPECT_FALSE(question.waits(false)) << "there is no MoveIt";
  question.follow(true, true, 0);
  ASSERT_TRUE(question.is_due(0));
  question.ask(0, start);
  EXPECT_FALSE(question.is_due(patience - 1));
  EXPECT_TRUE(question.is_due(patience));
  question.ask(patience, start);
  EXPECT_FALSE(question.answer(start - seconds));
  EXPECT_TRUE(question.waits(true) && question.is_due(patience + 1));
  question.ask(patience + 1, start);
  ASSERT_TRUE(question.answer(start));
  EXPECT_FALSE(question.waits(true));
  EXPECT_FALSE(question.is_due(10 * patience));
}

TEST(SceneQuestion, NoImagePassesBeforeTheAnswer) {
  io::SceneQuestion question;
  question.follow(false, false, 0);
  EXPECT_TRUE(question.waits(true)) << "the service came after the graph was followed";
  question.follow(false, true, 1);
  EXPECT_TRUE(question.waits(false)) << "a publisher of scenes mostly has the service, too";
  question.follow(false, true, 1 + patience);
  EXPECT_FALSE(question.waits(false)) << "it is a bag";
  question.follow(true, true, 2 + patience);
  question.ask(2 + patience, start);
  ASSERT_TRUE(question.answer(start));
  question.follow(false, false, 3 + patience);
  EXPECT_FALSE(question.waits(false)) << "MoveIt ended";
  question.follow(true, true, 4 + patience);
  EXPECT_TRUE(question.waits(true) && question.is_due(4 + patience)) << "it is back";
}

/// A MoveIt that publishes while it answers.
class BusyMoveItTest : public testing::Test {
 protected:
  BusyMoveItTest() {
    bench_.tell_all();
    bench_.tell_joints(bench_.now - 20 * milliseconds);
    bench_.tell_joints(bench_.now);
    question_.follow(true, true, bench_.now);
    question_.ask(bench_.now, bench_.inbox.robot().last_stamp());
    asked_ = bench_.now;
    bench_.now += 100 * milliseconds;
    bench_.tell_joints(bench_.now);
  }
  void publish(const io::PlanningSceneMessage& scene) {
    bench_.publish("/monitored_planning_scene", encoded(scene));
  }
  void change(std::uint8_t operation) {
    io::PlanningSceneMessage scene;
    scene.robot_state.is_diff = true;
    scene.robot_state.attached = {live_part(0, operation)};
    publish(scene);
  }
  /// Answers what was so when it was asked, and gives it the stamp of the question.
  void answer(bool with_part) {
    const auto from = question_.answer(bench_.inbox.robot().last_stamp());
    ASSERT_TRUE(from);
    io::PlanningSceneMessage scene;
    scene.robot_state.joints = {.header = {*from, ""}, .names = {"spin"}};
    if (with_part) scene.robot_state.attached = {live_part(0)};
    publish(scene);
  }
  std::size_t bodies_at(std::int64_t stamp) {
    bench_.tell_joints(stamp + 10 * milliseconds);
    bench_.tell_depth(stamp);
    EXPECT_EQ(bench_.work(), 1U);
    return bench_.job.pose.attached.size();
  }

  LiveBench bench_;
  io::SceneQuestion question_;
  std::int64_t asked_ = 0;
};

TEST_F(BusyMoveItTest, WhatIsAttachedMeanwhileStays) {
  change(io::CollisionObjectMessage::add);
  answer(false);
  EXPECT_EQ(bodies_at(bench_.now), 1U);
}

TEST_F(BusyMoveItTest, WhatIsDetachedMeanwhileIsGone) {
  change(io::CollisionObjectMessage::remove);
  answer(true);
  EXPECT_EQ(bodies_at(bench_.now), 0U);
}

TEST_F(BusyMoveItTest, ImagesThatWereTakenBeforeTheQuestionKnowTheAnswer) {
  answer(true);
  EXPECT_EQ(bodies_at(asked_ - 10 * milliseconds), 1U);
}

}  // namespace
}  // namespace penumbra::test
