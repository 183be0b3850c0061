// SPDX-License-Identifier: Apache-2.0
#include "../support/opengl.hpp"
#include "slab_scene.hpp"

#include <penumbra/diagnosis/diagnosis.hpp>
#include <penumbra/pipeline/without_robot.hpp>

namespace penumbra::test {
namespace {

/// The scene with something of each kind done to it, and the labels that must come of it.
struct EditedScene {
  Image<float> depth;
  Image<std::uint8_t> labels;
};

EditedScene edited_scene(const Camera& camera, double slide) {
  const Intrinsics& k = camera.intrinsics;
  EditedScene scene{scene_depth(camera, slide), Image<std::uint8_t>(k.width(), k.height())};
  const float changes[] = {0.0F, -0.3F, -0.021F, -0.019F, 0.039F, 0.041F, 0.8F};
  const Label labels[] = {Label::occluded, Label::front,  Label::front, Label::occluded,
                          Label::occluded, Label::beyond, Label::beyond};
  for (const auto [u, v] : each_pixel(k)) {
    const bool robot = cast(k.ray(u, v), slide).depth > 0.0;
    const int kind = u / 3 % 8;
    scene.depth(u, v) = kind < 7 ? scene.depth(u, v) + changes[kind] : 0.0F;
    const Label label = kind < 7 ? labels[kind] : Label::unknown;
    scene.labels(u, v) = std::uint8_t(robot ? label : Label::clear);
  }
  return scene;
}

PENUMBRA_BACKEND_TEST(PipelineOf);

TEST_P(PipelineOf, LabelsEveryPixelAsTheRuleSays) {
  const Camera camera = slab_camera();
  const EditedScene scene = edited_scene(camera, 0.1);
  const Image<std::uint16_t> millimetres = to_millimetres(scene.depth);
  Pipeline pipeline(slab_robot(), camera, plain_config(GetParam()));
  for (const DepthView& depth :
       {DepthView(scene.depth.view()), DepthView(std::as_const(millimetres).view())}) {
    const FrameReport& report =
        pipeline.process({.stamp = 7, .depth = depth, .pose = {.positions = {0.1}}});
    EXPECT_EQ(report.status, FrameStatus::ok) << report.message;
    EXPECT_EQ(report.stamp, 7);
    EXPECT_FALSE(report.joint_age.has_value());
    EXPECT_EQ(pixels_of(report.labels), pixels_of(scene.labels.view()));
    EXPECT_EQ(report.label(73, 57), Label(scene.labels(73, 57)));
    std::size_t counts[label_count] = {};
    for (const std::uint8_t label : pixels_of(scene.labels.view())) ++counts[label];
    EXPECT_EQ(report.pixels.front, counts[1]);
    EXPECT_EQ(report.pixels.occluded, counts[2]);
    EXPECT_EQ(report.pixels.unknown, counts[3]);
    EXPECT_EQ(report.pixels.beyond, counts[4]);
    EXPECT_EQ(report.pixels.uncovered, 0U);
    EXPECT_EQ(report.pixels.robot, counts[1] + counts[2] + counts[3] + counts[4]);
  }
}

TEST(RobotMask, IsWhereRaysMeetTheRobot) {
  const Camera camera = slab_camera();
  const Intrinsics& k = camera.intrinsics;
  for (const double slide : {-0.4, 0.0, 0.7}) {
    const Image<std::uint8_t> mask = robot_mask(slab_robot(), camera, {.positions = {slide}});
    Image<std::uint8_t> expected(k.width(), k.height());
    for (const auto [u, v] : each_pixel(k))
      expected(u, v) = cast(k.ray(u, v), slide).depth > 0.0 ? 255 : 0;
    EXPECT_EQ(pixels_of(mask.view()), pixels_of(std::as_const(expected).view()));
  }
}

TEST(RobotMask, RefusesWhatItWouldLack) {
  const auto refused = [](const Robot& robot, const Camera& camera, std::vector<double> positions,
                          const char* part) {
    const RobotPose pose{.positions = std::move(positions)};
    expect_refused([&] { static_cast<void>(robot_mask(robot, camera, pose)); }, {part});
  };
  Camera nowhere = slab_camera(), close = slab_camera();
  nowhere.T_parent_camera.reset();
  close.T_parent_camera->translation().z() = slab_depth - 0.005;
  refused(slab_robot(), nowhere, {0.0}, "T_parent_camera");
  refused(slab_robot(), close, {0.0}, "'slab'");
  refused(slab_robot(), slab_camera(), {}, "joint");
  refused(slab_robot(), slab_camera(), {0.0, 0.0}, "joint");
  refused(slab_robot(), slab_camera(), {nan}, "slide");
  refused(slab_robot(), slab_camera(), {90.0}, "'slide' is at 90");
  refused(slab_robot_without_mesh(), slab_camera(), {0.0}, "'lost'");
}

TEST(Pipeline, RefusesAFaultyConfiguration) {
  const std::pair<const char*, std::function<void(Camera&)>> faults[] = {
      {"slap", [](Camera& c) { c.parent = "slap"; }},
      {"T_parent_camera", [](Camera& c) { c.T_parent_camera.reset(); }},
      {"rigid", [](Camera& c) { c.T_parent_camera->linear() *= 1.001; }},
      {"rigid", [](Camera& c) { c.T_parent_camera->linear()(0, 0) = -1.0; }},
      {"rigid", [](Camera& c) { c.T_parent_camera->translation().x() = nan; }},
      {"camera pose", [](Camera& c) { c.T_parent_camera->translation().x() = 1e300; }},
      {"0.5", [](Camera& c) {
         c.range = {3.0, 0.5};
       }}};
  for (const auto& [part, spoil] : faults) {
    Camera camera = slab_camera();
    spoil(camera);
    expect_refused([&, &c = camera] { Pipeline(slab_robot(), c, plain_config()); }, {part});
  }
  PipelineConfig config = plain_config();
  config.renderer.threads = 0;
  expect_refused([&] { Pipeline(slab_robot(), slab_camera(), config); }, {"0"});
}

/// The fringe of a thing at the slab's left border, at its depth, after a frame in which the slab
/// was far from it.
std::size_t fringe_of_thing(double scene_memory, std::int64_t seconds_later = 1) {
  const Camera camera = camera_at_root(Intrinsics(1288, 968, 962.4, 949.6, 585.7, 459.4));
  PipelineConfig config = plain_config();
  config.rule.fringe_reach = 8;
  config.rule.scene_memory = scene_memory;
  Pipeline pipeline(slab_robot(), camera, config);
  const SlabBox thing{{-0.3005, 0.0, 1.0}, {0.2, 0.2, 0.1}, 0};
  const Image<float> before = scene_depth(camera, 1.0, {thing});
  const Image<float> now = scene_depth(camera, 0.0, {thing});
  Frame frame = frame_of(before, 1.0);
  frame.stamp = 1'000'000'000;
  EXPECT_EQ(pipeline.process(frame).pixels.fringe, 0U);
  frame = frame_of(now, 0.0);
  frame.stamp = (1 + seconds_later) * 1'000'000'000;
  return pipeline.process(frame).pixels.fringe;
}

TEST(SceneMemory, KeepsAThingThatWasSeenBefore) {
  const std::size_t alone = fringe_of_thing(0.0);
  EXPECT_EQ(fringe_of_thing(60.0), 0U);
  EXPECT_EQ(fringe_of_thing(60.0, 61), alone);
  EXPECT_GT(alone, 0U);
}

/// What is said of a box of the slab's depth that touches the slab at slide = 0, and then is
/// carried along by a share of the slab's motion.
std::vector<std::string> said_of_a_box(double share) {
  const Camera camera = slab_camera();
  PipelineConfig config = plain_config();
  config.rule.fringe_reach = 40;
  Pipeline pipeline(slab_robot(), camera, config);
  SetupCheck check(pipeline.robot(), camera, 0);
  for (const double slide : {0.0, 0.1, 0.3, 0.2}) {
    const SlabBox box{{-0.35, 0.0, 1.0 + share * slide}, {0.3, 0.2, 0.1}, 0};
    const Image<float> depth = scene_depth(camera, slide, {box});
    check.add(pipeline.process(frame_of(depth, slide)), {});
  }
  return check.missing_parts(config.rule.fringe_reach);
}

/// Which links carry a part that the URDF lacks.
TEST(MissingParts, NameTheLinkThatCarriesOneAndNotWhatStandsStill) {
  const std::vector<std::string> lines = said_of_a_box(1.0);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(holds(lines[0], "'slab'"));
  EXPECT_TRUE(said_of_a_box(0.0).empty());
}

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
  Camera camera = slab_camera();
  camera.T_parent_camera->translation() = Vector3d(0.0, 0.0, -1.0);
  Pipeline pipeline(slab_robot(), camera, plain_config());
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
