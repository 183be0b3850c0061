// SPDX-License-Identifier: Apache-2.0
// Several robots, against boxes and a ball that formulas intersect.
#include "../support/errors.hpp"
#include "../support/opengl.hpp"
#include "slab_scene.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <penumbra/mesh/primitives.hpp>
#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra::test {
namespace {

/// A box on a rail along x, at 0.1 m above its base.
constexpr const char* cart_urdf = R"(<robot name="cart">
  <link name="rail"/>
  <link name="box"><collision><geometry><box size="0.1 0.12 0.14"/></geometry></collision></link>
  <joint name="drive" type="prismatic">
    <parent link="rail"/><child link="box"/>
    <origin xyz="0 0.1 0"/><axis xyz="1 0 0"/><limit lower="-0.2" upper="0.15" effort="1" velocity="1"/>
  </joint>
</robot>)";

const Eigen::Vector3d cart_place(0.25, 0.05, 1.9);

/// The ball around the box on its way: around the way's middle, as half its length and half the
/// box's diagonal.
const Eigen::Vector3d cart_middle = cart_place + Eigen::Vector3d(0.025, -0.1, 0.0);
const double cart_reach = 0.175 + 0.5 * std::sqrt(0.1 * 0.1 + 0.12 * 0.12 + 0.14 * 0.14);

/// "slabs" stands in the world's origin, "cart" is turned by half a turn about z.
Robot cell() {
  Eigen::Isometry3d T_world_cart = Eigen::Isometry3d::Identity();
  T_world_cart.translation() = cart_place;
  T_world_cart.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
  const std::array robots{PlacedRobot{"slabs", slab_robot()},
                          PlacedRobot{"cart", Robot::parse(cart_urdf, "."), T_world_cart}};
  return Robot::join(robots);
}

SlabBox cart_box(double drive) {
  return {cart_place + Eigen::Vector3d(-drive, -0.1, 0.0), {0.1, 0.12, 0.14}, 6};
}

/// What the ray meets, with the cell's link values.
Seen cast_cell(const Eigen::Vector3d& ray, double slide, const std::vector<SlabBox>& more) {
  Seen seen = cast(ray, slide, more);
  if (seen.link == 2 || seen.link == 3) ++seen.link;  // the world comes first
  return seen;
}

/// The depth at which a ray (x, y, 1) from the origin enters a ball; 0: it does not.
double enter_ball(const Eigen::Vector3d& ray, const Eigen::Vector3d& centre, double radius) {
  const double a = ray.squaredNorm(), b = -2.0 * ray.dot(centre);
  const double c = centre.squaredNorm() - radius * radius;
  const double discriminant = b * b - 4.0 * a * c;
  return discriminant < 0.0 ? 0.0 : (-b - std::sqrt(discriminant)) / (2.0 * a);
}

Target region(const char* name, const PixelBox& box) {
  return {.name = name, .shape = RegionTarget{.region = box}};
}

class RobotsTest : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (!can_draw(GetParam())) GTEST_SKIP() << no_opengl;
  }
};
INSTANTIATE_TEST_SUITE_P(Backends, RobotsTest,
                         testing::Values(Backend::cpu, Backend::gl, Backend::reference),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST_P(RobotsTest, AreDrawnTogether) {
  const Camera camera = slab_camera();
  Pipeline pipeline(cell(), camera, plain_config(GetParam()));
  const auto links = pipeline.robot().links();
  EXPECT_EQ(std::vector<std::string>(links.begin(), links.end()),
            (std::vector<std::string>{"world", "slabs/base", "slabs/slab", "slabs/plate",
                                      "cart/rail", "cart/box"}));
  for (const auto& positions :
       std::vector<std::vector<double>>{{0.0, 0.0}, {0.3, -0.2}, {-0.1, 0.15}}) {
    const std::vector<SlabBox> boxes{cart_box(positions[1])};
    const Image<float> depth = scene_depth(camera, positions[0], boxes);
    const FrameReport& report =
        pipeline.process({.depth = depth.view(), .pose = {.positions = positions}});
    ASSERT_EQ(report.status, FrameStatus::ok) << report.message;
    for (int v = 0; v < depth.height(); ++v)
      for (int u = 0; u < depth.width(); ++u) {
        const Seen seen = cast_cell(camera.intrinsics.ray(u, v), positions[0], boxes);
        ASSERT_NEAR(report.virtual_depth.depth(u, v), seen.depth, depth_tolerance);
        ASSERT_EQ(report.virtual_depth.links(u, v), seen.link) << u << ',' << v;
      }
  }
}

/// Labels of a frame in which the cart may be anywhere in its ball.
void expect_unknown_reach(const FrameReport& report, const Image<float>& depth, double radius) {
  const Intrinsics& k = slab_camera().intrinsics;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u) {
      const Seen known = cast_cell(k.ray(u, v), 0.0, {});
      const double ball = enter_ball(k.ray(u, v), cart_middle, radius);
      Label expected = known.link == 0 ? Label::clear : Label::occluded;
      const bool is_ball = ball > 0.0 && (known.depth == 0.0 || ball < known.depth);
      if (is_ball) expected = depth(u, v) < ball - 0.02 ? Label::front : Label::unknown;
      ASSERT_EQ(report.labels(u, v), static_cast<int>(expected)) << u << ',' << v;
    }
}

TEST_P(RobotsTest, WhatOneOfUnknownPoseCanReachIsUnknown) {
  const Camera camera = slab_camera();
  Pipeline pipeline(cell(), camera, plain_config(GetParam()));
  Image<float> depth = scene_depth(camera, 0.0, {cart_box(0.1)});
  for (int v = 40; v < 45; ++v)  // a thing before the ball
    for (int u = 92; u < 98; ++u) depth(u, v) = 1.3F;
  const std::vector<double> positions{0.0, 0.0};
  const std::vector<std::size_t> cart{4, 5};
  const std::vector<Target> targets{region("free", PixelBox{3, 3, 6, 6}),
                                    region("at cart", PixelBox{86, 38, 4, 4}),
                                    region("behind slab", PixelBox{68, 54, 6, 6})};
  const FrameReport& report =
      pipeline.process({.depth = depth.view(),
                        .pose = {.positions = positions,
                                 .uncertain_links = cart,
                                 .uncertain_reason = "its joints are stale"},
                        .targets = targets});
  EXPECT_EQ(report.status, FrameStatus::missing_link);
  EXPECT_EQ(report.message,
            "link 'cart/rail' is not drawn, and what it could hide is unknown: its joints are "
            "stale");
  EXPECT_TRUE(report.missing_links.empty()) << "the mask can be trusted elsewhere";
  EXPECT_FALSE(report.T_root_link[5].matrix().allFinite());
  expect_unknown_reach(report, depth, cart_reach);
  EXPECT_GT(report.pixels.unknown, 300U);
  EXPECT_GT(report.pixels.front, 10U);
  EXPECT_EQ(report.targets[0].verdict, Verdict::visible);
  EXPECT_EQ(report.targets[1].verdict, Verdict::unknown);
  EXPECT_NE(report.targets[1].reason.find("its joints are stale"), std::string_view::npos);
  EXPECT_EQ(report.targets[2].verdict, Verdict::hidden);
}

/// Targets with a depth, where the cart could be before, at or behind them.
TEST_P(RobotsTest, OneOfUnknownPoseHidesNothingForSure) {
  const Camera camera = slab_camera();
  Pipeline pipeline(cell(), camera, plain_config(GetParam()));
  Image<float> depth = scene_depth(camera, 0.0, {cart_box(0.1)});
  const PixelBox at_cart{86, 38, 4, 4}, behind_slab{68, 54, 6, 6};
  const auto targets_at = [&](double metres) {
    std::vector<Target> targets{region("at cart", at_cart), region("behind slab", behind_slab)};
    for (Target& target : targets) std::get<RegionTarget>(target.shape).expected_depth = metres;
    return targets;
  };
  const auto fill = [&](float metres) {
    for (int v = 38; v < 42; ++v)
      for (int u = 86; u < 90; ++u) depth(u, v) = metres;
  };
  for (const double expected : {1.2, 1.5, 1.8, 2.0, 2.5})
    for (const float measured : {0.0F, 1.0F, 1.3F, 1.75F, 2.0F, 2.5F, 3.0F}) {
      fill(measured);
      const FrameReport& report =
          pipeline.process({.depth = depth.view(),
                            .pose = {.positions = {0.0, 0.0},
                                     .uncertain_links = {4, 5},
                                     .uncertain_reason = "its joints are stale"},
                            .targets = targets_at(expected)});
      const Verdict verdict = report.targets[0].verdict;
      // The ball's near side is at 1.6 m. What is measured before it is something else.
      const bool is_before_ball = measured > 0.0F && measured < 1.5F;
      if (!is_before_ball) {
        EXPECT_EQ(verdict, Verdict::unknown) << expected << ' ' << measured;
        EXPECT_EQ(report.targets[0].judgement->occluded, 0.0) << expected << ' ' << measured;
      }
      EXPECT_EQ(report.targets[0].judgement->blame.size(), 0U) << expected << ' ' << measured;
      EXPECT_EQ(report.targets[1].verdict, Verdict::hidden) << "by the slab, which is known";
    }
}

/// The slab's depth, carried past its outline, lies before the cart's ball.
TEST(Robots, FringeBeforeOneOfUnknownPoseIsNotTrusted) {
  PipelineConfig config = plain_config();
  config.rule.fringe_reach = LabelRule().fringe_reach;
  Pipeline pipeline(cell(), slab_camera(), config);
  Image<float> depth = scene_depth(slab_camera(), 0.0);
  for (int v = 50; v < 65; ++v)
    for (int u = 99; u < 104; ++u) depth(u, v) = depth(97, v);
  const auto labels_of = [&](std::vector<std::size_t> uncertain) {
    const FrameReport& report =
        pipeline.process({.depth = depth.view(),
                          .pose = {.positions = std::vector<double>{0.0, 0.15},
                                   .uncertain_links = std::move(uncertain),
                                   .uncertain_reason = "stale"}});
    std::array<std::size_t, label_count> pixels{};
    std::vector<int> labels;
    for (int v = 50; v < 65; ++v)
      for (int u = 99; u < 104; ++u) labels.push_back(report.labels(u, v));
    for (int v = 0; v < depth.height(); ++v)
      for (int u = 0; u < depth.width(); ++u) ++pixels[report.labels(u, v)];
    EXPECT_EQ(pixels[static_cast<std::size_t>(Label::fringe)], report.pixels.fringe);
    EXPECT_EQ(pixels[static_cast<std::size_t>(Label::front)], report.pixels.front);
    return labels;
  };
  const std::vector<int> fringe(75, static_cast<int>(Label::fringe));
  EXPECT_EQ(labels_of({}), fringe);
  for (const int label : labels_of({4, 5}))
    EXPECT_TRUE(label == static_cast<int>(Label::fringe) || label == unknown_label) << label;
}

TEST(Robots, WhatOneOfUnknownPoseCarriesReachesFarther) {
  Pipeline pipeline(cell(), slab_camera(), plain_config());
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  const std::vector<double> positions{0.0, 0.0};
  const std::vector<std::size_t> cart{4, 5};
  const Eigen::Vector3d size(0.1, 0.1, 0.1);
  const std::vector<AttachedBody> held{{"part", "cart/box",
                                        std::make_shared<PreparedMesh>(make_box(size)),
                                        Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.0))}};
  const FrameReport& report = pipeline.process({.depth = depth.view(),
                                                .pose = {.positions = positions,
                                                         .uncertain_links = cart,
                                                         .uncertain_reason = "stale",
                                                         .attached = held}});
  EXPECT_EQ(report.status, FrameStatus::missing_link);
  const Intrinsics& k = slab_camera().intrinsics;
  for (const double drive : {-0.2, -0.1, 0.0, 0.1, 0.15}) {
    const SlabBox part{cart_box(drive).centre + Eigen::Vector3d(-0.1, 0.0, 0.0), size, 7};
    for (int v = 0; v < depth.height(); ++v)
      for (int u = 0; u < depth.width(); ++u) {
        if (cast_cell(k.ray(u, v), 0.0, {part}).link != 7) continue;
        ASSERT_EQ(report.labels(u, v), unknown_label) << u << ',' << v << " at " << drive;
      }
  }
}

TEST(Robots, ACameraOnARobotOfUnknownPoseSeesNothing) {
  PipelineConfig config = plain_config();
  config.camera_parent = "cart/box";
  config.T_parent_camera.translation() = Eigen::Vector3d(0.0, 0.0, 0.2);
  Pipeline pipeline(cell(), slab_camera(), config);
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  const std::vector<double> positions{0.0, 0.0};
  const std::vector<std::size_t> cart{4, 5};
  const FrameReport& report = pipeline.process(
      {.depth = depth.view(),
       .pose = {.positions = positions, .uncertain_links = cart, .uncertain_reason = "stale"}});
  EXPECT_EQ(report.status, FrameStatus::missing_transform);
  EXPECT_EQ(report.labels(0, 0), unknown_label);
}

/// Joint states of both robots; the cart's end at 1 s.
class RobotsInTime : public testing::Test {
 protected:
  RobotsInTime() : robot_(cell()), history_(robot_) {
    const std::array<std::string, 2> names{"slabs/slide", "cart/drive"};
    for (int i = 1; i <= 20; ++i) {
      const std::array positions{0.0, 0.1};
      const std::size_t known = i <= 10 ? 2 : 1;
      history_.add_joints(i * 100 * ms, std::span(names).first(known),
                          std::span(positions).first(known), "driver");
    }
  }
  Robot robot_;
  PoseHistory history_;
};

TEST_F(RobotsInTime, ARobotWithStaleJointsIsUncertainAlone) {
  PoseLookup lookup(robot_, {});
  RobotPose answer;
  lookup.at(history_, 950 * ms, answer);
  EXPECT_EQ(answer.status, FrameStatus::ok);
  EXPECT_TRUE(answer.uncertain_links.empty());
  lookup.at(history_, 1850 * ms, answer);
  EXPECT_EQ(answer.status, FrameStatus::ok);
  EXPECT_EQ(answer.uncertain_links, (std::vector<std::size_t>{4, 5}));
  EXPECT_NE(answer.uncertain_reason.find("cart/drive"), std::string::npos);
}

TEST_F(RobotsInTime, ARobotThatCarriesTheCameraIsNeeded) {
  PoseLookup lookup(robot_, {.camera_parent = "cart/box"});
  RobotPose answer;
  lookup.at(history_, 1850 * ms, answer);
  EXPECT_EQ(answer.status, FrameStatus::stale_joints);
}

TEST(Robots, OfWhichTheTransformsOfOneEndAreUncertainAlone) {
  const Robot robot = cell();
  PoseHistory history(robot);
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 1.0)); };
  for (int i = 1; i <= 20; ++i) {
    history.add_transform(i * 100 * ms, "slabs/base", "slabs/slab", at(0.0), "driver");
    if (i <= 10) history.add_transform(i * 100 * ms, "cart/rail", "cart/box", at(0.1), "driver");
  }
  PoseLookup lookup(robot, {.source = PoseSource::transforms});
  RobotPose answer;
  lookup.at(history, 1850 * ms, answer);
  EXPECT_EQ(answer.status, FrameStatus::ok) << answer.message;
  EXPECT_EQ(answer.uncertain_links, (std::vector<std::size_t>{4, 5}));
  EXPECT_NE(answer.uncertain_reason.find("cart/box"), std::string::npos) << answer.uncertain_reason;
}

TEST(Robots, WhoseTransformsAreLateAreAwaited) {
  const Robot robot = cell();
  PoseHistory history(robot);
  FrameQueue queue(robot, history, {.poses = {.source = PoseSource::transforms}});
  const auto tell = [&](const char* parent, const char* child, std::int64_t stamp) {
    history.add_transform(stamp, parent, child, Eigen::Isometry3d::Identity(), "driver");
  };
  for (const std::int64_t stamp : {1000 * ms, 1050 * ms}) tell("slabs/base", "slabs/slab", stamp);
  tell("cart/rail", "cart/box", 1000 * ms);
  queue.push({.stamp = 1050 * ms}, 1051 * ms);
  EXPECT_FALSE(queue.next(1051 * ms));
  tell("cart/rail", "cart/box", 1050 * ms);
  auto frame = queue.next(1059 * ms);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->pose.uncertain_links.empty());
  tell("slabs/base", "slabs/slab", 1300 * ms);
  tell("slabs/base", "slabs/slab", 1400 * ms);
  queue.push({.stamp = 1100 * ms}, 1410 * ms);
  EXPECT_FALSE(queue.next(1410 * ms));
  queue.push({.stamp = 1300 * ms}, 1410 * ms);
  frame = queue.next(1410 * ms);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->stamp, 1300 * ms) << "the cart is silent for more than the longest wait";
  EXPECT_EQ(frame->pose.uncertain_links, (std::vector<std::size_t>{4, 5}));
}

/// The cart's base is published anew, 0.3 m aside, as after a calibration.
TEST(Robots, StandWhereTheirBasesWerePublishedLast) {
  const Robot robot = cell();
  Eigen::Isometry3d T_world_cart = robot.joints()[3].origin;
  for (const PoseSource source : {PoseSource::joints, PoseSource::both}) {
    PoseHistory history(robot);
    history.add_static_transform("world", "slabs/base", Eigen::Isometry3d::Identity());
    history.add_static_transform("world", "cart/rail", T_world_cart);
    const std::array<std::string, 2> names{"slabs/slide", "cart/drive"};
    const std::array positions{0.0, 0.1};
    for (int i = 1; i <= 10; ++i) {
      history.add_joints(i * 100 * ms, names, positions, "driver");
      history.add_transform(i * 100 * ms, "slabs/base", "slabs/slab",
                            Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1)), "driver");
      Eigen::Isometry3d T_rail_box(Eigen::Translation3d(0.1, 0.1, 0));
      history.add_transform(i * 100 * ms, "cart/rail", "cart/box", T_rail_box, "driver");
    }
    PoseLookup lookup(robot, {.source = source});
    RobotPose answer;
    lookup.at(history, 550 * ms, answer);
    ASSERT_EQ(answer.status, FrameStatus::ok) << answer.message;
    EXPECT_EQ(answer.positions, (std::vector{0.0, 0.1})) << "they follow from the joints";
    const Eigen::Isometry3d moved = Eigen::Translation3d(0.3, 0, 0) * T_world_cart;
    history.add_static_transform("world", "cart/rail", moved);
    lookup.at(history, 550 * ms, answer);
    ASSERT_EQ(answer.status, FrameStatus::ok) << answer.message;
    const Camera camera = slab_camera();
    Pipeline pipeline(robot, camera, plain_config());
    SlabBox box = cart_box(0.1);
    box.centre.x() += 0.3;
    const Image<float> depth = scene_depth(camera, 0.0, {box});
    const FrameReport& report = pipeline.process({.depth = depth.view(), .pose = answer});
    EXPECT_EQ(report.status, FrameStatus::ok) << report.message;
    for (int v = 0; v < depth.height(); ++v)
      for (int u = 0; u < depth.width(); ++u)
        ASSERT_EQ(report.virtual_depth.links(u, v),
                  cast_cell(camera.intrinsics.ray(u, v), 0.0, {box}).link)
            << u << ',' << v;
  }
}

TEST(Robots, MoveAsTheyDoAlone) {
  const Robot slabs = slab_robot(), cart = Robot::parse(cart_urdf, "."), both = cell();
  const std::vector<double> positions{0.2, -0.1};
  std::vector<Eigen::Isometry3d> a(slabs.links().size()), b(cart.links().size()), ab(6);
  slabs.forward_kinematics(std::span(positions).first(1), a);
  cart.forward_kinematics(std::span(positions).subspan(1), b);
  both.forward_kinematics(positions, ab);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(ab[1 + i].isApprox(a[i], 1e-12));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(ab[4 + i].isApprox(ab[4] * b[i], 1e-12));
  EXPECT_EQ(both.find_variable("cart/drive"), 1U);
  EXPECT_EQ(both.part_of(0), nullptr);
  EXPECT_EQ(both.part_of(3)->name, "slabs");
  EXPECT_EQ(both.part_of(4)->name, "cart");
}

TEST(Robots, WithoutNamesOfTheirOwnAreRefused) {
  for (const char* const name : {"", "slabs", "a/b"}) {
    const std::array robots{PlacedRobot{"slabs", slab_robot()}, PlacedRobot{name, slab_robot()}};
    expect_refused([&] { (void)Robot::join(robots); }, {name, "name"});
  }
  PlacedRobot bent{"bent", slab_robot()};
  bent.T_world_root.linear() *= 2.0;
  expect_refused([&] { (void)Robot::join({&bent, 1}); }, {"'bent'", "rigid"});
}

}  // namespace
}  // namespace penumbra::test
