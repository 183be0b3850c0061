// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "random_robot.hpp"

#include <gtest/gtest.h>

#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

// Chains of some tens of links of a metre, each rotation rounded to 1e-16.
constexpr double kPoseTolerance = 1e-12;

inline std::vector<double> random_positions(Random& random, const Robot& robot) {
  std::vector<double> positions(robot.variables().size());
  for (double& value : positions) value = uniform(random, -3.0, 3.0);
  return positions;
}

inline void expect_pose(const Eigen::Isometry3d& pose, const Matrix& expected,
                        const std::string& link) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      EXPECT_NEAR(pose.matrix()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)),
                  expected[i][j], kPoseTolerance)
          << link << " row " << i << " column " << j;
}

/// Poses every link at random positions and compares with the plain matrices.
inline void expect_kinematics(Random& random, const Robot& robot, const PlainRobot& plain) {
  const auto positions = random_positions(random, robot);
  Positions by_name;
  for (std::size_t i = 0; i < positions.size(); ++i) by_name[robot.variables()[i]] = positions[i];
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
    expect_pose(poses[i], pose_of(plain, robot.links()[i], by_name), robot.links()[i]);
}

}  // namespace penumbra::test
