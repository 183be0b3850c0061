// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

namespace penumbra::test {
namespace {

/// A pipeline that has just judged a good frame, whose images must not show again.
class FrameStatusTest : public testing::Test {
 protected:
  FrameStatusTest() : depth_(scene_depth(camera_, 0.0)), pipeline_(slab_robot(), camera_) {
    EXPECT_EQ(process(good()).status, FrameStatus::ok);
  }

  [[nodiscard]] Frame good() const { return with_joints({0.0}); }
  [[nodiscard]] Frame with_joints(std::vector<double> positions) const {
    return {.depth = depth_.view(), .pose = {.positions = std::move(positions)}};
  }
  [[nodiscard]] Frame with_links() const {
    const Robot robot = slab_robot();
    Frame frame{.depth = depth_.view()};
    frame.pose.T_root_link.resize(robot.links().size());
    robot.forward_kinematics(std::vector{0.0}, frame.pose.T_root_link);
    return frame;
  }
  [[nodiscard]] Frame flawed(FrameStatus status, std::string_view message) const {
    Frame frame = good();
    frame.source_status = status;
    frame.source_message = message;
    return frame;
  }
  const FrameReport& process(const Frame& frame) { return pipeline_.process(frame); }

  const FrameReport& expect_unknown(const Frame& frame, FrameStatus status, const char* says) {
    const FrameReport& report = process(frame);
    EXPECT_EQ(report.status, status);
    EXPECT_TRUE(holds(report.message, says));
    EXPECT_EQ(pixels_of(report.labels), std::vector<std::uint8_t>(depth_.size(), unknown_label));
    EXPECT_EQ(report.pixels.unknown, depth_.size());
    return report;
  }

  void expect_pose_unknown(const Frame& frame, FrameStatus status, const char* says) {
    const FrameReport& report = expect_unknown(frame, status, says);
    EXPECT_TRUE(report.virtual_depth.depth.empty() && report.virtual_depth.links.empty());
    EXPECT_FALSE(report.pixels.robot.has_value());
    EXPECT_EQ(process(good()).status, FrameStatus::ok) << "the stream goes on";
  }

  void expect_all_unknown(const Frame& frame, FrameStatus status, const char* says) {
    const FrameReport& report = expect_unknown(frame, status, says);
    ASSERT_FALSE(report.virtual_depth.depth.empty());
    const std::vector<float> drawn = pixels_of(report.virtual_depth.depth);
    const auto robot = std::ranges::count_if(drawn, [](float z) { return z > 0.0F; });
    EXPECT_GT(robot, 0);
    EXPECT_EQ(report.pixels.robot, std::size_t(robot));
  }

  Camera camera_ = slab_camera();
  Image<float> depth_;
  Pipeline pipeline_;
};

TEST_F(FrameStatusTest, WithoutAPoseAllIsUnknown) {
  expect_pose_unknown(with_joints({}), FrameStatus::missing_joints, "no joint positions");
  const std::pair<std::vector<double>, const char*> bad[] = {
      {{}, "1 joint"},     {{0.0, 0.0}, "1 joint"}, {{nan}, "'slide'"},  {{inf}, "'slide'"},
      {{-inf}, "'slide'"}, {{1e300}, "'slide'"},    {{1.1e6}, "'slab'"}, {{-1e7}, "'slab'"}};
  for (const auto& [positions, says] : bad)
    expect_pose_unknown(with_joints(positions), FrameStatus::missing_joints, says);
  expect_pose_unknown(flawed(FrameStatus::missing_transform, "from 'a' to 'b'"),
                      FrameStatus::missing_transform, "from 'a' to 'b'");
  Frame neither = with_joints({});
  neither.depth = {};
  expect_pose_unknown(neither, FrameStatus::missing_joints, "no joint positions");
}

TEST_F(FrameStatusTest, WithoutDepthAllIsUnknown) {
  Frame frame = good();
  frame.depth = {};
  expect_all_unknown(frame, FrameStatus::missing_depth, "no depth image");
  const Image<std::uint16_t> other(depth_.width() + 1, depth_.height(), 900);
  frame.depth = other.view();
  expect_all_unknown(frame, FrameStatus::bad_depth, "162x121");
  expect_all_unknown(flawed(FrameStatus::bad_depth, "depth_3.png"), FrameStatus::bad_depth,
                     "depth_3.png");
  camera_.range = {0.3, 1.6};
  pipeline_ = Pipeline(slab_robot(), camera_);
  const Image<float> wall(depth_.width(), depth_.height(), 3.0F);
  frame.depth = wall.view();
  expect_all_unknown(frame, FrameStatus::bad_depth, "1.6 m");
}

/// As blind as no image.
TEST_F(FrameStatusTest, DepthWithoutAnyMeasurement) {
  Frame frame = good();
  for (const std::uint16_t value : {std::uint16_t{0}, saturated_depth}) {
    Image<std::uint16_t> dead(depth_.width(), depth_.height(), value);
    frame.depth = dead.view();
    expect_all_unknown(frame, FrameStatus::bad_depth, "no pixel");
    process(frame);
    dead(dead.width() - 1, dead.height() - 1) = 900;
    EXPECT_EQ(process(frame).status, FrameStatus::ok) << "one pixel is measured";
    EXPECT_FALSE(process(frame).nothing_measured);
  }
  for (const float value : {0.0F, -1.0F, std::nanf(""), std::numeric_limits<float>::infinity()}) {
    const Image<float> dead(depth_.width(), depth_.height(), value);
    frame.depth = dead.view();
    expect_all_unknown(frame, FrameStatus::bad_depth, "no pixel");
    EXPECT_TRUE(process(frame).nothing_measured);
  }
  frame.source_status = FrameStatus::missing_depth;
  EXPECT_FALSE(process(frame).nothing_measured) << "there was no image";
}

/// The slab's middle lies just behind its near face.
TEST(FrameStatusOfRobot, ACameraInsideOfALinkIsAFaultOfTheFrame) {
  PipelineConfig config = plain_config();
  config.T_parent_camera.translation() = Vector3d(0.0, 0.0, -1.0);
  Pipeline pipeline(slab_robot(), slab_camera(), config);
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  for (const bool is_inside : {true, false, true}) {
    const FrameReport& report =
        pipeline.process(frame_of(depth, is_inside ? -slab_depth - 1.05 : 0.0));
    EXPECT_EQ(report.status, is_inside ? FrameStatus::missing_transform : FrameStatus::ok);
    EXPECT_EQ(report.T_root_camera.has_value(), !is_inside);
    EXPECT_EQ(report.message.find("'slab'") != std::string::npos, is_inside) << report.message;
    EXPECT_EQ(report.message.find("ignore_links") != std::string::npos, is_inside);
    EXPECT_EQ(report.virtual_depth.depth.empty(), is_inside);
  }
}

TEST_F(FrameStatusTest, GivenPosesOfTheCameraHoldForTheirFrameAlone) {
  Frame moved = with_links();
  moved.pose.T_parent_camera = at(0.0, 0.0, -0.5);
  const float behind = process(moved).virtual_depth.depth(73, 57);
  const float before = process(with_links()).virtual_depth.depth(73, 57);
  EXPECT_NEAR(before, slab_depth, 1e-5);
  EXPECT_NEAR(behind, before + 0.5, 1e-5);
}

TEST_F(FrameStatusTest, GivenPosesThatArePoorAreRefused) {
  using Poses = std::vector<Isometry3d>;
  const std::pair<const char*, std::function<void(Poses&)>> faults[] = {
      {"2 poses for 3 links", [](Poses& poses) { poses.pop_back(); }},
      {"'slab'", [](Poses& poses) { poses[1].translation().x() = nan; }},
      {"'plate'", [](Poses& poses) { poses[2].linear() *= 1.01; }},
      {"'base'", [](Poses& poses) { poses[0].translation().x() = 1e-3; }},
      {"'slab'", [](Poses& poses) { poses[1].translation().x() = 1e8; }}};
  for (const auto& [names, spoil] : faults) {
    Frame bad = with_links();
    spoil(bad.pose.T_root_link);
    expect_pose_unknown(bad, FrameStatus::missing_transform, names);
  }
  Frame camera = with_links();
  camera.pose.T_parent_camera = Isometry3d::Identity();
  camera.pose.T_parent_camera->linear().setZero();
  expect_pose_unknown(camera, FrameStatus::missing_transform, "camera's pose");
}

}  // namespace
}  // namespace penumbra::test
