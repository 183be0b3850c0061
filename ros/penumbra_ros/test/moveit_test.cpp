// SPDX-License-Identifier: Apache-2.0
// The node and a MoveIt that says what is attached.
#include "move_group.hpp"
#include "node_fixture.hpp"

#include <algorithm>

#include <diagnostic_msgs/msg/diagnostic_array.hpp>

namespace penumbra_ros::test {
namespace {

// MoveIt sends changes alone: a node that starts later, or again, has to ask.
TEST_F(NodeTest, WhatWasAttachedBeforeIsAskedForWheneverMoveItComes) {
  start();
  const auto robot_pixels = [&] {
    const auto labels = labels_of(0);
    if (!labels) return std::ptrdiff_t{-1};
    return std::count_if(labels->data.begin(), labels->data.end(),
                         [](std::uint8_t label) { return label != 0; });
  };
  const auto arm = robot_pixels();
  ASSERT_GT(arm, 0);
  auto moveit = std::make_unique<MoveIt>(true);
  executor_->add_node(moveit->node);
  EXPECT_TRUE(spin_until([&] { return robot_pixels() > 2 * arm; })) << moveit->asked;
  EXPECT_EQ(moveit->asked, 1);
  executor_->remove_node(moveit->node);
  moveit.reset();
  const auto client =
      player_->node->create_client<moveit_msgs::srv::GetPlanningScene>("/get_planning_scene");
  EXPECT_TRUE(spin_until([&] { return !client->service_is_ready(); }));
  int checks = 0;  // in each, the node looks for MoveIt
  const auto diagnostics =
      player_->node->create_subscription<diagnostic_msgs::msg::DiagnosticArray>(
          "/diagnostics", 10,
          [&](diagnostic_msgs::msg::DiagnosticArray::ConstSharedPtr) { ++checks; });
  EXPECT_TRUE(spin_until([&] { return checks > 1; }));
  EXPECT_GT(robot_pixels(), 2 * arm) << "the box stays while nobody says otherwise";
  MoveIt next(false);
  executor_->add_node(next.node);
  EXPECT_TRUE(spin_until([&] { return robot_pixels() == arm; })) << next.asked;
}

TEST_F(NodeTest, MoveItIsAskedAgainIfItsAnswerIsLostAndMayPublishMeanwhile) {
  MoveIt moveit(true);
  moveit.lost = 1;
  moveit.is_busy = true;
  executor_->add_node(moveit.node);
  start();
  EXPECT_EQ(moveit.asked, 2);
}

TEST_F(NodeTest, NothingIsJudgedBeforeMoveItSaysWhatIsAttached) {
  MoveIt moveit(true);
  executor_->add_node(moveit.node);
  start();
  EXPECT_EQ(moveit.asked, 1);
  const auto first = received_.begin()->second, later = labels_of(0);
  ASSERT_TRUE(later);
  EXPECT_EQ(first->data, later->data) << "the box was there from the first image on";
}

}  // namespace
}  // namespace penumbra_ros::test
