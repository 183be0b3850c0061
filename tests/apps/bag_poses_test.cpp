// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags whose joints come from transforms, or from several publishers.
#include "fixtures.hpp"

#include <cstdint>

#include <Eigen/Geometry>

namespace penumbra::test {
namespace {

TEST_F(BagTest, TakesPosesFromTransforms) {
  for (std::int64_t stamp = tiny_stamp(0) - 130'000'000; stamp < tiny_stamp(3);
       stamp += 100'000'000) {
    const double seconds = static_cast<double>(stamp - tiny_stamp(0)) * 1e-9;
    const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 1 + tiny_speed * seconds));
    bag_.add("/tf", stamp, io::TfMessage{{{{stamp, "base"}, "board", pose}}});
  }
  for (const char* const poses : {"tf", "both", "joints"}) {
    ASSERT_EQ(run({"--poses", poses}).status, 0) << poses;
    expect_recorded_labels();
  }
  bag_.edit<io::TfMessage>(
      "/tf", [](auto& tf) { tf.transforms[0].T_parent_child.translation().z() += 0.01; });
  const Outcome outcome = run({"--poses", "both"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(status(1), "poses_disagree");
  expect_has(outcome.err, {"poses_disagree", "3 of 3"});

  bag_.remove("/joint_states");
  expect_has(run().out, {"poses: from tf"});
}

TEST_F(BagTest, JointStatesOfTwoPublishersThatDisagreeAreReportedAndNotUsed) {
  // joint_state_publisher beside the driver: all joints of its own order, no sliders moved.
  for (std::int64_t stamp = tiny_stamp(0) - 190'000'000; stamp < tiny_stamp(3);
       stamp += 100'000'000)
    bag_.add("/joint_states", stamp,
             io::JointStateMessage{
                 .header = {stamp, ""}, .names = {"slide", "other"}, .positions = {-0.3, 0.0}});
  Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(status(1), "poses_disagree");
  for (const char* const part : {"poses_disagree", "3 of 3", "joint 'slide' is at ",
                                 "/joint_states (2 joints from "
                                 "'other')",
                                 "/joint_states (2 joints from 'slide')"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
}

TEST_F(BagTest, TheFirstPublisherMayBeBelieved) {
  bag_.copy("/joint_states", "/second/joint_states");
  bag_.edit<io::JointStateMessage>("/second/joint_states", [](auto& state) {
    state.header.stamp += 1'000'000;
    state.positions[1] = -0.3;
  });
  const std::vector<std::string> both = {"--joint-topic", "/joint_states", "--joint-topic",
                                         "/second/joint_states"};
  EXPECT_EQ(run(both).status, 2);
  std::vector<std::string> first = both;
  first.push_back("--first-publisher");
  ASSERT_EQ(run(first).status, 0);
  expect_recorded_labels();
}

TEST_F(BagTest, ACopyOfJointStatesIsUsedAsTheyAre) {
  bag_.copy("/joint_states", "/relayed/joint_states");
  bag_.edit<io::JointStateMessage>("/relayed/joint_states",
                                   [](auto& state) { state.header.stamp += 30'000'000; });
  ASSERT_EQ(
      run({"--joint-topic", "/relayed/joint_states", "--joint-topic", "/joint_states"}).status, 0);
  expect_recorded_labels();
}

}  // namespace
}  // namespace penumbra::test
