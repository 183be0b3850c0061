// SPDX-License-Identifier: Apache-2.0
// Frames that bring poses of links, or of the camera, themselves.
#include "slab_scene.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

class GivenPoses : public testing::Test {
 protected:
  GivenPoses() : depth_(scene_depth(camera_, 0.1)), links_(robot_.links().size()) {
    robot_.forward_kinematics(std::vector<double>{0.1}, links_);
  }

  [[nodiscard]] Frame frame() const {
    Frame frame;
    frame.depth = depth_.view();
    frame.pose.T_root_link = links_;
    return frame;
  }

  void expect_refused(const Frame& frame, const std::string& names) {
    const FrameReport& report = pipeline_.process(frame);
    EXPECT_EQ(report.status, FrameStatus::missing_transform) << report.message;
    EXPECT_NE(report.message.find(names), std::string::npos) << report.message;
    EXPECT_TRUE(report.virtual_depth.depth.empty());
    EXPECT_FALSE(report.pixels.robot);
  }

  Camera camera_ = slab_camera();
  Robot robot_ = slab_robot();
  Image<float> depth_;
  std::vector<Eigen::Isometry3d> links_;
  Pipeline pipeline_{slab_robot(), camera_, plain_config()};
};

TEST_F(GivenPoses, OfLinksGiveWhatTheirJointsGive) {
  const std::vector<double> positions = {0.1};
  const FrameReport& by_joints =
      pipeline_.process({.depth = depth_.view(), .pose = {.positions = positions}});
  const auto depth = pixels_of(by_joints.virtual_depth.depth);
  const auto labels = pixels_of(by_joints.labels);
  ASSERT_GT(by_joints.pixels.occluded, 100U);
  Frame given = frame();
  given.pose.age = 7;
  const FrameReport& by_poses = pipeline_.process(given);
  EXPECT_EQ(by_poses.status, FrameStatus::ok) << by_poses.message;
  EXPECT_EQ(pixels_of(by_poses.virtual_depth.depth), depth);
  EXPECT_EQ(pixels_of(by_poses.labels), labels);
  EXPECT_EQ(by_poses.joint_age, 7);
  EXPECT_TRUE(by_poses.T_root_link[1].isApprox(links_[1]));
}

TEST_F(GivenPoses, OfTheCameraHoldForTheirFrameAlone) {
  Frame moved = frame();
  moved.pose.T_parent_camera = Eigen::Translation3d(0.0, 0.0, -0.5) * Eigen::Isometry3d::Identity();
  const float behind = pipeline_.process(moved).virtual_depth.depth(73, 57);
  const float before = pipeline_.process(frame()).virtual_depth.depth(73, 57);
  EXPECT_NEAR(before, slab_depth + 0.1, 1e-5);
  EXPECT_NEAR(behind, before + 0.5, 1e-5);
}

TEST_F(GivenPoses, ThatArePoorAreRefused) {
  const std::vector<Eigen::Isometry3d> good = links_;
  links_.pop_back();
  expect_refused(frame(), "2 poses for 3 links");
  links_ = good;
  links_[1].translation().x() = std::nan("");
  expect_refused(frame(), "'slab'");
  links_ = good;
  links_[2].linear() *= 1.01;
  expect_refused(frame(), "'plate'");
  links_ = good;
  links_[0].translation().x() = 1e-3;
  expect_refused(frame(), "'base'");
  links_ = good;
  links_[1].translation().x() = 1e8;
  expect_refused(frame(), "'slab'");
  links_ = good;
  Frame camera = frame();
  camera.pose.T_parent_camera = links_[1];
  camera.pose.T_parent_camera->linear().setZero();
  expect_refused(camera, "camera's pose");
  EXPECT_EQ(pipeline_.process(frame()).status, FrameStatus::ok) << "the stream goes on";
}

}  // namespace
}  // namespace penumbra::test
