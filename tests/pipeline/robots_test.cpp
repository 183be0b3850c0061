// SPDX-License-Identifier: Apache-2.0
// Several robots, against boxes and a ball that formulas intersect.
#include "../support/opengl.hpp"
#include "slab_scene.hpp"

#include <penumbra/mesh/primitives.hpp>
#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/poses/reach.hpp>

namespace penumbra::test {
namespace {

/// A box on a rail along x, at 0.1 m above its base.
Robot cart() {
  return parse(
      robot_xml(link_xml("rail") + link_xml("box", box_xml("0.1 0.12 0.14")) +
                joint_xml("drive", "prismatic", "rail", "box",
                          R"(<origin xyz="0 0.1 0"/><limit lower="-0.2" upper="0.15"/>)")));
}

const Vector3d cart_place(0.25, 0.05, 1.9);

/// The ball around the box on its way: around the way's middle, as half its length and half the
/// box's diagonal.
const Vector3d cart_middle = cart_place + Vector3d(0.025, -0.1, 0.0);
const double cart_reach = 0.175 + 0.5 * std::sqrt(0.1 * 0.1 + 0.12 * 0.12 + 0.14 * 0.14);

/// "slabs" stands in the world's origin, "cart" is turned by half a turn about z.
Robot cell() {
  Isometry3d T_world_cart = at(cart_place);
  T_world_cart.rotate(AngleAxisd(std::numbers::pi, Vector3d::UnitZ()));
  const std::array robots{PlacedRobot{"slabs", slab_robot()},
                          PlacedRobot{"cart", cart(), T_world_cart}};
  return Robot::join(robots);
}

SlabBox cart_box(double drive) {
  return {cart_place + Vector3d(-drive, -0.1, 0.0), {0.1, 0.12, 0.14}, 6};
}

/// What the ray meets, with the cell's link values.
Seen cast_cell(const Vector3d& ray, double slide, const std::vector<SlabBox>& more) {
  Seen seen = cast(ray, slide, more);
  if (seen.link == 2 || seen.link == 3) ++seen.link;  // the world comes first
  return seen;
}

const std::vector<std::size_t> cart_links{4, 5};

/// A frame in which the cart's pose is not known.
Frame without_cart(const Image<float>& depth, std::vector<Target> targets = {}) {
  return {
      .depth = depth.view(),
      .pose = {.positions = {0.0, 0.0}, .uncertain_links = cart_links, .uncertain_reason = "stale"},
      .targets = std::move(targets)};
}

/// The depth at which a ray (x, y, 1) from the origin enters a ball; 0: it does not.
double enter_ball(const Vector3d& ray, const Vector3d& centre, double radius) {
  const double a = ray.squaredNorm(), b = -2.0 * ray.dot(centre);
  const double c = centre.squaredNorm() - radius * radius, discriminant = b * b - 4.0 * a * c;
  return discriminant < 0.0 ? 0.0 : (-b - std::sqrt(discriminant)) / (2.0 * a);
}

const PixelBox at_cart{86, 38, 4, 4}, behind_slabs{68, 54, 6, 6};

PENUMBRA_BACKEND_TEST(RobotsTest);

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
    expect_drawn(report.virtual_depth,
                 [&](const auto& ray) { return cast_cell(ray, positions[0], boxes); });
  }
}

/// Labels of a frame in which the cart may be anywhere in its ball.
void expect_unknown_reach(const FrameReport& report, const Image<float>& depth, double radius) {
  const Intrinsics& k = slab_camera().intrinsics;
  for (const auto [u, v] : each_pixel(depth)) {
    const Seen known = cast_cell(k.ray(u, v), 0.0, {});
    const double ball = enter_ball(k.ray(u, v), cart_middle, radius);
    Label expected = known.link == 0 ? Label::clear : Label::occluded;
    const bool is_ball = ball > 0.0 && (known.depth == 0.0 || ball < known.depth);
    if (is_ball) expected = depth(u, v) < ball - 0.02 ? Label::front : Label::unknown;
    ASSERT_EQ(report.labels(u, v), int(expected)) << u << ',' << v;
  }
}

TEST_P(RobotsTest, WhatOneOfUnknownPoseCanReachIsUnknown) {
  const Camera camera = slab_camera();
  Pipeline pipeline(cell(), camera, plain_config(GetParam()));
  Image<float> depth = scene_depth(camera, 0.0, {cart_box(0.1)});
  for (const auto [u, v] : each_pixel(92, 40, 98, 45)) depth(u, v) = 1.3F;  // before the ball
  const FrameReport& report = pipeline.process(
      without_cart(depth, {region("free", PixelBox{3, 3, 6, 6}), region("at cart", at_cart),
                           region("behind slab", behind_slabs)}));
  EXPECT_EQ(report.status, FrameStatus::missing_link);
  EXPECT_TRUE(holds(report.message, {"'cart/rail'", "stale"}));
  EXPECT_TRUE(report.missing_links.empty()) << "the mask can be trusted elsewhere";
  EXPECT_FALSE(report.T_root_link[5].matrix().allFinite());
  expect_unknown_reach(report, depth, cart_reach);
  EXPECT_GT(report.pixels.unknown, 300U);
  EXPECT_GT(report.pixels.front, 10U);
  expect_verdicts(report, {Verdict::visible, Verdict::unknown, Verdict::hidden});
  EXPECT_TRUE(holds(report.targets[1].reason, "stale"));
}

/// Targets with a depth, where the cart could be before, at or behind them.
TEST_P(RobotsTest, OneOfUnknownPoseHidesNothingForSure) {
  const Camera camera = slab_camera();
  Pipeline pipeline(cell(), camera, plain_config(GetParam()));
  Image<float> depth = scene_depth(camera, 0.0, {cart_box(0.1)});
  const auto targets_at = [&](double metres) {
    std::vector<Target> targets{region("at cart", at_cart), region("behind slab", behind_slabs)};
    for (Target& target : targets) std::get<RegionTarget>(target.shape).expected_depth = metres;
    return targets;
  };
  for (const double expected : {1.2, 1.5, 1.8, 2.0, 2.5})
    for (const float measured : {0.0F, 1.0F, 1.3F, 1.75F, 2.0F, 2.5F, 3.0F}) {
      SCOPED_TRACE(testing::Message() << expected << ' ' << measured);
      for (const auto [u, v] : each_pixel(86, 38, 90, 42)) depth(u, v) = measured;
      const FrameReport& report = pipeline.process(without_cart(depth, targets_at(expected)));
      const TargetReport& target = report.targets[0];
      // The ball's near side is at 1.6 m. What is measured before it is something else.
      if (measured == 0.0F || measured >= 1.5F) {
        EXPECT_EQ(target.verdict, Verdict::unknown);
        EXPECT_EQ(target.judgement->occluded, 0.0);
      }
      EXPECT_TRUE(target.judgement->blame.empty());
      EXPECT_EQ(report.targets[1].verdict, Verdict::hidden) << "by the slab, which is known";
    }
}

/// The slab's depth, carried past its outline, lies before the cart's ball.
TEST(Robots, FringeBeforeOneOfUnknownPoseIsNotTrusted) {
  PipelineConfig config = plain_config();
  config.rule.fringe_reach = LabelRule().fringe_reach;
  Pipeline pipeline(cell(), slab_camera(), config);
  Image<float> depth = scene_depth(slab_camera(), 0.0);
  for (const auto [u, v] : each_pixel(99, 50, 104, 65)) depth(u, v) = depth(97, v);
  const auto labels_of = [&](std::vector<std::size_t> uncertain) {
    Frame frame = without_cart(depth);
    frame.pose.positions = {0.0, 0.15};
    frame.pose.uncertain_links = std::move(uncertain);
    const FrameReport& report = pipeline.process(frame);
    std::array<std::size_t, label_count> pixels{};
    std::vector<int> labels;
    for (const auto [u, v] : each_pixel(99, 50, 104, 65)) labels.push_back(report.labels(u, v));
    for (const auto [u, v] : each_pixel(depth)) ++pixels[report.labels(u, v)];
    EXPECT_EQ(pixels[std::size_t(Label::fringe)], report.pixels.fringe);
    EXPECT_EQ(pixels[std::size_t(Label::front)], report.pixels.front);
    return labels;
  };
  const std::vector<int> fringe(75, int(Label::fringe));
  EXPECT_EQ(labels_of({}), fringe);
  for (const int label : labels_of(cart_links))
    EXPECT_TRUE(label == int(Label::fringe) || label == unknown_label) << label;
}

TEST(Robots, WhatOneOfUnknownPoseCarriesReachesFarther) {
  Pipeline pipeline(cell(), slab_camera(), plain_config());
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  const Vector3d size(0.1, 0.1, 0.1);
  Frame frame = without_cart(depth);
  frame.pose.attached = {
      {"part", "cart/box", std::make_shared<PreparedMesh>(make_box(size)), at(0.1, 0.0, 0.0)}};
  const FrameReport& report = pipeline.process(frame);
  EXPECT_EQ(report.status, FrameStatus::missing_link);
  const Intrinsics& k = slab_camera().intrinsics;
  for (const double drive : {-0.2, -0.1, 0.0, 0.1, 0.15}) {
    const SlabBox part{cart_box(drive).centre + Vector3d(-0.1, 0.0, 0.0), size, 7};
    for (const auto [u, v] : each_pixel(depth))
      if (cast_cell(k.ray(u, v), 0.0, {part}).link == 7) {
        ASSERT_EQ(report.labels(u, v), unknown_label) << u << ',' << v << " at " << drive;
      }
  }
}

RobotPose pose_at(std::int64_t stamp, const PoseHistory& history, const PoseOptions& options = {}) {
  RobotPose answer;
  PoseLookup(cell(), options).at(history, stamp * ms, answer);
  return answer;
}

const std::array<std::string, 2> cell_joints{"slabs/slide", "cart/drive"};

/// The cart's joint states and transforms end at 1 s.
TEST(Robots, WithStaleJointsAreUncertainAloneUnlessTheyCarryTheCamera) {
  const Robot robot = cell();
  PoseHistory history(robot);
  const std::array positions{0.0, 0.1};
  for (int i = 1; i <= 20; ++i) {
    const std::size_t known = i <= 10 ? 2 : 1;
    history.add_joints(i * 100 * ms, std::span(cell_joints).first(known),
                       std::span(positions).first(known), "driver");
    history.add_transform(i * 100 * ms, "slabs/base", "slabs/slab", at(0.0, 0.0, 1.0), "driver");
    if (known == 2)
      history.add_transform(i * 100 * ms, "cart/rail", "cart/box", at(0.1, 0.0, 1.0), "driver");
  }
  EXPECT_EQ(pose_at(950, history).status, FrameStatus::ok);
  EXPECT_TRUE(pose_at(950, history).uncertain_links.empty());
  for (const auto& [source, reason] : {std::pair(PoseSource::joints, "cart/drive"),
                                       std::pair(PoseSource::transforms, "cart/box")}) {
    const RobotPose stale = pose_at(1850, history, {.source = source});
    EXPECT_EQ(stale.status, FrameStatus::ok) << stale.message;
    EXPECT_EQ(stale.uncertain_links, cart_links);
    EXPECT_TRUE(holds(stale.uncertain_reason, reason));
  }
  EXPECT_EQ(pose_at(1850, history, {.camera_parent = "cart/box"}).status,
            FrameStatus::stale_joints);
}

TEST(Robots, WhoseTransformsAreLateAreAwaited) {
  const Robot robot = cell();
  PoseHistory history(robot);
  FrameQueue queue(robot, history, {.poses = {.source = PoseSource::transforms}});
  const auto tell = [&](const char* parent, const char* child, std::int64_t stamp) {
    history.add_transform(stamp * ms, parent, child, Isometry3d::Identity(), "driver");
  };
  for (const std::int64_t stamp : {1000, 1050}) tell("slabs/base", "slabs/slab", stamp);
  tell("cart/rail", "cart/box", 1000);
  queue.push({.stamp = 1050 * ms}, 1051 * ms);
  EXPECT_FALSE(queue.next(1051 * ms));
  tell("cart/rail", "cart/box", 1050);
  const auto frame = queue.next(1059 * ms);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->pose.uncertain_links.empty());
}

/// The cart's base is published anew, 0.3 m aside, as after a calibration.
TEST(Robots, StandWhereTheirBasesWerePublishedLast) {
  const Robot robot = cell();
  PoseHistory history(robot);
  const Isometry3d T_world_cart = robot.joints()[3].origin;
  history.add_joints(100 * ms, cell_joints, std::array{0.0, 0.1});
  history.add_transform(100 * ms, "slabs/base", "slabs/slab", at(0, 0, 1));
  history.add_transform(100 * ms, "cart/rail", "cart/box", at(0.1, 0.1, 0));
  history.add_static_transform("world", "slabs/base", Isometry3d::Identity());
  for (const double aside : {0.0, 0.3}) {
    history.add_static_transform("world", "cart/rail", Translation3d(aside, 0, 0) * T_world_cart);
    SlabBox box = cart_box(0.1);
    box.centre.x() += aside;
    for (const PoseSource source : {PoseSource::joints, PoseSource::both}) {
      Pipeline pipeline(robot, slab_camera(), plain_config());
      const FrameReport& report =
          pipeline.process({.pose = pose_at(100, history, {.source = source})});
      expect_drawn(report.virtual_depth,
                   [&](const auto& ray) { return cast_cell(ray, 0.0, {box}); });
    }
  }
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

// The balls that bound where links can be, against random positions of random arms.

constexpr std::array types{"revolute", "continuous", "prismatic", "fixed"};

/// A chain of boxes with a branch after each second link.
std::string random_arm(std::mt19937_64& random) {
  std::uniform_real_distribution<double> metres(-0.3, 0.3), size(0.02, 0.2), angle(-3.0, 3.0);
  const auto triple = [&](auto& of) {
    std::ostringstream text;
    text << of(random) << ' ' << of(random) << ' ' << of(random);
    return text.str();
  };
  std::ostringstream urdf;
  urdf << "<robot name=\"random\">";
  for (int i = 0; i < 9; ++i)
    urdf << "<link name=\"l" << i << "\"><collision><origin xyz=\"" << triple(metres)
         << "\"/><geometry><box size=\"" << triple(size) << "\"/></geometry></collision></link>";
  for (int i = 1; i < 9; ++i)
    urdf << "<joint name=\"j" << i << "\" type=\"" << types[random() % types.size()]
         << "\"><parent link=\"l" << (i % 3 == 0 ? i - 2 : i - 1) << "\"/><child link=\"l" << i
         << "\"/><origin xyz=\"" << triple(metres) << "\" rpy=\"" << triple(angle)
         << "\"/><axis xyz=\"" << triple(metres)
         << "\"/><limit lower=\"-0.1\" upper=\"0.25\" effort=\"1\" velocity=\"1\"/></joint>";
  urdf << "</robot>";
  return urdf.str();
}

TEST(Reach, HoldsAllVerticesAtAnyPosition) {
  auto random = seeded_random(11);
  constexpr double rounding = 1e-6;  // metres: vertices are floats
  double fullest = 0.0;              // largest distance from a ball's centre, of its radius
  for (int arm = 0; arm < 20; ++arm) {
    const Robot robot = Robot::parse(random_arm(random), ".");
    const std::vector<Ball> reach = reach_of_links(robot);
    std::vector<double> positions(robot.variables().size());
    std::vector<Isometry3d> poses(robot.links().size());
    for (int sample = 0; sample < 300; ++sample) {
      for (const Joint& joint : robot.joints())
        if (joint.variable)
          positions[*joint.variable] =
              joint.type == JointType::prismatic
                  ? std::uniform_real_distribution(*joint.lower, *joint.upper)(random)
                  : std::uniform_real_distribution(-4.0, 4.0)(random);
      robot.forward_kinematics(positions, poses);
      for (std::size_t link = 0; link < poses.size(); ++link)
        for (const PreparedMesh& mesh : robot.meshes(link))
          for (const Vector3f& vertex : mesh.vertices) {
            const double distance = (poses[link] * vertex.cast<double>() - reach[0].centre).norm();
            ASSERT_LE(distance, reach[0].radius + rounding) << robot.links()[link];
            fullest = std::max(fullest, distance / reach[0].radius);
          }
    }
  }
  EXPECT_GT(fullest, 0.8) << "the balls are no larger than needed";
}

}  // namespace
}  // namespace penumbra::test
