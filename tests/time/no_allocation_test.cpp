// SPDX-License-Identifier: Apache-2.0
#include "../robot/urdf_text.hpp"
#include "../support/allocations.hpp"

#include <gtest/gtest.h>

#include <penumbra/time/joint_buffer.hpp>
#include <penumbra/time/transform_buffer.hpp>

namespace penumbra::test {
namespace {

TEST(NoAllocation, InKinematics) {
  const Robot robot = every_kind();
  const auto positions = robot.rest_positions();
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  const std::size_t before = allocations();
  robot.forward_kinematics(positions, poses);
  EXPECT_EQ(allocations(), before);
}

TEST(NoAllocation, InTheJointBufferOnceItIsWarm) {
  const Robot robot = every_kind();
  JointBuffer buffer(robot, {.max_gap = 1.0, .history = 1e-6});
  const auto names = std::vector<std::string>(robot.variables().begin(), robot.variables().end());
  const auto positions = robot.rest_positions();
  JointAnswer answer;
  std::int64_t stamp = 0;
  const auto step = [&] {
    buffer.insert(stamp, names, positions);
    buffer.at(stamp - 1, answer);
    stamp += 10;
  };
  buffer.at(-1, answer);
  for (int i = 0; i < 1000; ++i) step();
  const std::size_t before = allocations();
  for (int i = 0; i < 1000; ++i) step();
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(answer.status, JointStatus::ok);
}

TEST(NoAllocation, InTheTransformBufferOnceItIsWarm) {
  TransformBuffer buffer({.max_gap = 1.0, .history = 1e-6});
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const char* const frames[] = {"base_of_the_robot", "first_link_of_the_robot", "second_link",
                                "third_link_of_the_robot", "camera_colour_optical_frame"};
  buffer.insert_static(frames[0], frames[4], T);
  TransformAnswer answer;
  std::int64_t stamp = 10;
  const auto step = [&] {
    for (int i = 0; i < 3; ++i) buffer.insert(stamp, frames[i], frames[i + 1], T);
    buffer.at(stamp - 1, frames[4], frames[3], answer);
    stamp += 10;
  };
  for (int i = 0; i < 1000; ++i) step();
  const std::size_t before = allocations();
  for (int i = 0; i < 1000; ++i) step();
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(answer.status, TransformStatus::ok);
}

}  // namespace
}  // namespace penumbra::test
