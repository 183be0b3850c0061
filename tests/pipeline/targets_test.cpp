// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/primitives.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t ms = 1'000'000;

/// Depths are float32 metres of about 1.
constexpr double depth_rounding = 1e-5;

/// The slab's near face spans u 48..98, v 45..69 at slide 0, u 37..110 at slide -0.3; the wall
/// stands at 3 m.
const PixelBox behind_slab{60, 50, 20, 12};
const PixelBox beside_slab{10, 80, 20, 12};

class TargetsTest : public testing::Test {
 protected:
  explicit TargetsTest(double history = 0.0)
      : pipeline_(slab_robot(), slab_camera(), [&] {
          PipelineConfig config = plain_config();
          config.target_history = history;
          return config;
        }()) {}

  const FrameReport& process(std::int64_t stamp, std::span<const Target> targets) {
    return pipeline_.process(
        {.stamp = stamp, .depth = depth_.view(), .joints = positions_, .targets = targets});
  }
  const TargetReport& judge(std::int64_t stamp, const Target& target) {
    return process(stamp, {&target, 1}).targets[0];
  }

  Image<float> depth_ = scene_depth(slab_camera(), 0.0);
  std::vector<double> positions_{0.0};
  Pipeline pipeline_;
};

Target region(const char* name, const Region& shape) {
  return {.name = name, .shape = RegionTarget{shape}};
}

TEST_F(TargetsTest, AreJudgedWhereTheySee) {
  const std::vector<Target> targets{region("hidden", behind_slab), region("clear", beside_slab),
                                    region("outside", PixelBox{400, 400, 9, 9})};
  const FrameReport& report = process(1, targets);
  ASSERT_EQ(report.targets.size(), 3U);
  EXPECT_TRUE(report.timing.targets);
  const TargetReport& hidden = report.targets[0];
  EXPECT_EQ(hidden.name, "hidden");
  EXPECT_EQ(hidden.verdict, Verdict::hidden) << hidden.reason;
  EXPECT_EQ(hidden.judgement->inside, 240U);
  EXPECT_EQ(hidden.judgement->occluded, 1.0);
  ASSERT_EQ(hidden.judgement->blame.size(), 1U);
  EXPECT_EQ(report.links[hidden.judgement->blame[0].link], "slab");
  EXPECT_FALSE(hidden.point) << "its depth is the robot's";
  EXPECT_EQ(report.targets[1].verdict, Verdict::visible);
  ASSERT_TRUE(report.targets[1].point);
  EXPECT_NEAR(report.targets[1].point->z(), wall_depth, depth_rounding);
  EXPECT_EQ(report.targets[2].verdict, Verdict::out_of_view);
}

TEST_F(TargetsTest, PointsAreOfTheRootsFrame) {
  PipelineConfig config = plain_config();
  config.T_parent_camera.translation() = Eigen::Vector3d(0.3, -0.2, 0.0);
  Pipeline moved(slab_robot(), slab_camera(), config);
  Image<float> wall(depth_.width(), depth_.height(), 2.0F);
  const Target target = region("wall", PixelBox{20, 90, 9, 9});
  const FrameReport& report = moved.process(
      {.stamp = 1, .depth = wall.view(), .joints = positions_, .targets = {&target, 1}});
  ASSERT_TRUE(report.targets[0].point) << report.targets[0].reason;
  const Eigen::Vector3d expected =
      Eigen::Vector3d(0.3, -0.2, 0.0) + 2.0 * slab_camera().intrinsics.ray(24, 94);
  EXPECT_LT((*report.targets[0].point - expected).norm(), depth_rounding);
}

/// A link's frame, the root's and the camera's name the same place.
TEST_F(TargetsTest, SolidsAreSeenAlikeFromEveryFrame) {
  positions_[0] = 0.1;
  depth_ = scene_depth(slab_camera(), 0.1);
  Eigen::Isometry3d in_camera = Eigen::Isometry3d::Identity();
  in_camera.translation() = Eigen::Vector3d(0.02, 0.01, 1.6);
  Eigen::Isometry3d in_slab = in_camera;
  in_slab.translation().z() -= 1.1;
  const auto mesh = std::make_shared<const TriangleMesh>(make_box({0.1, 0.1, 0.1}));
  const std::vector<Target> targets{
      {.name = "camera", .shape = BoxTarget{in_camera, {0.1, 0.1, 0.1}, {}}},
      {.name = "root", .shape = BoxTarget{in_camera, {0.1, 0.1, 0.1}, ""}},
      {.name = "link", .shape = BoxTarget{in_slab, {0.1, 0.1, 0.1}, "slab"}},
      {.name = "mesh", .shape = MeshTarget{mesh, in_camera, {}}},
      {.name = "before", .shape = PointTarget{{0.02, 0.01, 0.5}, 0.02, ""}},
      {.name = "behind", .shape = PointTarget{{0.02, 0.01, 1.6}, 0.02, {}}}};
  const FrameReport& report = process(1, targets);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(report.targets[i].verdict, Verdict::hidden) << report.targets[i].reason;
    EXPECT_EQ(report.targets[i].judgement->covered, report.targets[0].judgement->covered);
  }
  // The near face at 1.55 m, 0.1 m wide.
  EXPECT_NEAR(static_cast<double>(report.targets[0].judgement->covered),
              0.1 * 120.3 / 1.55 * 0.1 * 118.7 / 1.55, 10.0);
  EXPECT_EQ(report.targets[4].verdict, Verdict::visible)
      << "no robot stands between: " << report.targets[4].reason;
  EXPECT_EQ(report.targets[5].verdict, Verdict::hidden);
}

/// Hidden needs no sensor depth where the expected depth is known; without it the frame is unknown.
TEST_F(TargetsTest, AreUnknownWithoutPoseOrDepth) {
  const Target target = region("target", beside_slab);
  Frame frame{.stamp = 1, .depth = {}, .joints = positions_, .targets = {&target, 1}};
  const auto reason_of = [&](FrameStatus status) {
    const FrameReport& report = pipeline_.process(frame);
    EXPECT_EQ(report.status, status);
    EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
    EXPECT_FALSE(report.targets[0].judgement);
    return std::string(report.targets[0].reason);
  };
  EXPECT_EQ(reason_of(FrameStatus::missing_depth), "missing_depth: no depth image");
  frame.depth = depth_.view();
  frame.joints = {};
  EXPECT_NE(reason_of(FrameStatus::missing_joints).find("missing_joints"), std::string::npos);
}

TEST(TargetsWithoutALink, AreNeverVisible) {
  Robot robot = Robot::parse(
      slab_urdf(R"(<link name="gone"><collision><geometry><mesh filename="gone.stl"/></geometry>
                   </collision></link>
                   <joint name="weld" type="fixed"><parent link="base"/><child link="gone"/>
                   </joint>)"),
      ".", {.allow_missing_meshes = true});
  Pipeline pipeline(std::move(robot), slab_camera(), plain_config());
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  const std::vector<double> positions{0.0};
  const std::vector<Target> targets{region("clear", beside_slab), region("hidden", behind_slab)};
  const FrameReport& report = pipeline.process(
      {.stamp = 1, .depth = depth.view(), .joints = positions, .targets = targets});
  ASSERT_EQ(report.status, FrameStatus::missing_link);
  EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
  EXPECT_NE(report.targets[0].reason.find("'gone'"), std::string_view::npos);
  EXPECT_FALSE(report.targets[0].point) << "the link's own body may be there";
  EXPECT_EQ(report.targets[1].verdict, Verdict::hidden);
}

TEST_F(TargetsTest, FaultsOfATargetAreItsReason) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Isometry3d bent = Eigen::Isometry3d::Identity();
  bent.linear() *= 1.1;
  const std::vector<Eigen::Vector2d> bow{{10, 10}, {50, 50}, {50, 10}, {10, 50}};
  const Image<std::uint8_t> small(7, 7, 1);
  TargetThresholds wrong;
  wrong.partial_enter = 2.0;
  PoseTrackerConfig lame;
  lame.timeout = -1.0;
  struct Case {
    Target target;
    const char* told;
  };
  const std::vector<Case> cases{
      {{.name = "a"}, "not found"},
      {region("", beside_slab), "no name"},
      {region("b", PixelBox{nan, 0, 5, 5}), ""},
      {region("c", PixelBox{5, 5, 0, 5}), ""},
      {region("d", PixelPolygon{bow}), "cross"},
      {region("e", PixelMask{small.view()}), ""},
      {{.name = "f", .shape = RegionTarget{beside_slab, Extent::amodal, -1.0}}, "expected depth"},
      {{.name = "g", .shape = RegionTarget{beside_slab}, .frame_id = "other"}, "image frame"},
      {{.name = "h", .shape = RegionTarget{beside_slab}, .stamp = 7}, "target_history"},
      {{.name = "i", .shape = RegionTarget{beside_slab}, .thresholds = wrong}, "partial_enter"},
      {{.name = "j", .shape = RegionTarget{beside_slab}, .handling = lame}, "timeout"},
      {{.name = "k", .shape = RegionTarget{beside_slab}, .fault = "its file is bad"},
       "its file is bad"},
      {{.name = "l", .shape = KeypointTarget{.pixel = {20, 85}, .score = 0.1, .min_score = 0.3}},
       "score 0.1 is below 0.3"},
      {{.name = "m", .shape = KeypointTarget{.pixel = {20, 85}, .score = nan}}, "score"},
      {{.name = "n", .shape = KeypointTarget{.pixel = {nan, 85}}}, "pixel"},
      {{.name = "o", .shape = KeypointTarget{.pixel = {20, 85}, .semi_axes = {0, 5}}}, "semi-axis"},
      {{.name = "p", .shape = PointTarget{{nan, 0, 1}, 0.02, {}}}, "position"},
      {{.name = "q", .shape = PointTarget{{0, 0, 1}, 0.0, {}}}, "radius"},
      {{.name = "r", .shape = PointTarget{{0, 0, 1}, 0.1, "arm"}}, "no link"},
      {{.name = "s", .shape = BoxTarget{bent, {0.1, 0.1, 0.1}, {}}}, "rigid"},
      {{.name = "t", .shape = BoxTarget{Eigen::Isometry3d::Identity(), {0.1, 0, 0.1}, {}}}, ""},
      {{.name = "u", .shape = MeshTarget{}}, "triangles"}};
  for (const Case& one : cases) {
    const TargetReport& report = judge(1, one.target);
    EXPECT_EQ(report.verdict, Verdict::unknown) << one.target.name;
    EXPECT_NE(report.reason, "") << one.target.name;
    EXPECT_NE(report.reason.find(one.told), std::string_view::npos) << report.reason;
    EXPECT_FALSE(report.point);
  }
}

TEST_F(TargetsTest, NamesUsedTwiceAreBothUnknown) {
  const std::vector<Target> targets{region("same", beside_slab), region("other", beside_slab),
                                    region("same", behind_slab)};
  for (int i = 0; i < 2; ++i) {
    const FrameReport& report = process(i, targets);
    EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
    EXPECT_EQ(report.targets[1].verdict, Verdict::visible);
    EXPECT_EQ(report.targets[2].verdict, Verdict::unknown);
    EXPECT_NE(report.targets[2].reason.find("twice"), std::string_view::npos);
  }
  EXPECT_EQ(judge(3, targets[0]).verdict, Verdict::visible);
}

TEST_F(TargetsTest, TenThousandAreJudged) {
  std::vector<std::string> names;
  for (int i = 0; i < 10000; ++i) names.push_back("target " + std::to_string(i));
  std::vector<Target> targets;
  for (const std::string& name : names)
    targets.push_back(region(name.c_str(), targets.size() % 2 == 0 ? beside_slab : behind_slab));
  const FrameReport& report = process(1, targets);
  ASSERT_EQ(report.targets.size(), targets.size());
  for (std::size_t i = 0; i < targets.size(); ++i)
    ASSERT_EQ(report.targets[i].verdict, i % 2 == 0 ? Verdict::visible : Verdict::hidden);
}

TEST_F(TargetsTest, KeypointsInMetresTakeTheDepthAtTheirPixel) {
  KeypointTarget shape{.pixel = {20, 85}, .semi_axes = {0.3, 0.3}, .in_metres = true};
  const TargetReport& report = judge(1, {.name = "k", .shape = shape});
  const double radius = 0.3 * 120.3 / wall_depth;
  EXPECT_NEAR(static_cast<double>(report.judgement->covered), std::numbers::pi * radius * radius,
              2.0 * std::numbers::pi * radius * 0.5);
  depth_(20, 85) = 0.0F;
  EXPECT_NE(judge(2, {.name = "k", .shape = shape}).reason.find("no depth is measured"),
            std::string_view::npos);
}

// ---- Handling

Target followed(const PixelBox& box) {
  return {.name = "hand", .shape = RegionTarget{box}, .handling = PointTrackerConfig{}};
}

TEST_F(TargetsTest, AHiddenPointIsHeld) {
  const TargetReport seen = judge(0, followed(beside_slab));
  ASSERT_TRUE(seen.handled);
  EXPECT_EQ(seen.estimate, penumbra::Outcome::accepted);
  EXPECT_EQ(seen.handled->source, Source::measured);
  EXPECT_EQ(seen.handled->position, seen.point);
  const TargetReport hidden = judge(100 * ms, followed(behind_slab));
  EXPECT_FALSE(hidden.estimate) << "there is no point to take";
  EXPECT_EQ(hidden.handled->source, Source::held);
  EXPECT_NEAR(hidden.handled->age, 0.1, 1e-9);
  EXPECT_EQ(hidden.handled->position, seen.point);
  EXPECT_GT(hidden.handled->sigma, seen.handled->sigma);
  const TargetReport gone = judge(9000 * ms, {.name = "hand", .handling = PointTrackerConfig{}});
  EXPECT_EQ(gone.handled->source, Source::lost);
  EXPECT_FALSE(gone.handled->position);
}

TEST_F(TargetsTest, BeforeTheFirstEstimateNothingIsKnown) {
  const TargetReport report = judge(0, followed(behind_slab));
  EXPECT_EQ(report.handled->source, Source::lost);
  EXPECT_TRUE(std::isinf(report.handled->sigma)) << "not 0, which would look certain";
  EXPECT_TRUE(std::isinf(report.handled->age));
}

Target estimated(std::int64_t stamp, const PixelBox& box, double x) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, 0.0, 2.0);
  return {.name = "crate",
          .shape = RegionTarget{box},
          .handling = PoseTrackerConfig{},
          .estimate = TargetEstimate{.value = pose, .stamp = stamp, .frame = ""}};
}

TEST_F(TargetsTest, EstimatesCountWithTheVerdictOfTheirOwnStamp) {
  // Seen at 0 and 100 ms, hidden at 200; estimates come 100 ms late.
  EXPECT_EQ(judge(0, estimated(0, beside_slab, 0.0)).estimate, penumbra::Outcome::accepted);
  EXPECT_EQ(judge(100 * ms, {.name = "crate", .shape = RegionTarget{beside_slab}}).verdict,
            Verdict::visible);
  const TargetReport late = judge(200 * ms, estimated(100 * ms, behind_slab, 0.01));
  EXPECT_EQ(late.verdict, Verdict::hidden);
  EXPECT_EQ(late.estimate, penumbra::Outcome::accepted) << "it was visible when it was found";
  EXPECT_EQ(late.handled->source, Source::predicted);
  const TargetReport back = judge(300 * ms, estimated(200 * ms, beside_slab, 0.02));
  EXPECT_EQ(back.estimate, penumbra::Outcome::refused_verdict) << "it was hidden then";
  const TargetReport other = judge(400 * ms, estimated(350 * ms, beside_slab, 0.03));
  EXPECT_EQ(other.estimate, penumbra::Outcome::refused_verdict) << "no frame of that stamp";
}

TEST_F(TargetsTest, NothingIsAcceptedWithoutPoseOrDepth) {
  PoseTrackerConfig any;
  any.worst = Verdict::hidden;
  Target target = estimated(0, beside_slab, 0.0);
  target.handling = any;
  EXPECT_EQ(judge(0, target).estimate, penumbra::Outcome::accepted);
  target.estimate->stamp = 100 * ms;
  Frame frame{.stamp = 100 * ms, .depth = depth_.view(), .joints = {}, .targets = {&target, 1}};
  EXPECT_EQ(pipeline_.process(frame).targets[0].estimate, penumbra::Outcome::refused_verdict);
  frame.stamp = target.estimate->stamp = 200 * ms;
  frame.joints = positions_;
  frame.depth = DepthView{};
  const TargetReport& report = pipeline_.process(frame).targets[0];
  EXPECT_EQ(report.estimate, penumbra::Outcome::refused_verdict);
  EXPECT_EQ(report.handled->source, Source::predicted) << "handling goes on";
}

TEST_F(TargetsTest, EstimatesOfTheCameraAreBroughtToTheRoot) {
  PipelineConfig config = plain_config();
  config.T_parent_camera.translation().x() = 0.25;
  config.camera_parent = "slab";  // eye in hand
  config.T_parent_camera.translation().z() = -1.2;
  Pipeline pipeline(slab_robot(), slab_camera(), config);
  const Image<float> wall(depth_.width(), depth_.height(), 3.0F);
  for (int i = 0; i < 3; ++i) {
    positions_[0] = 0.05 * i;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(0.0, 0.0, 2.0 - 0.05 * i);  // still in the root's frame
    Target target = estimated(i * 100 * ms, PixelBox{2, 100, 12, 12}, 0.0);
    target.estimate->frame.reset();
    target.estimate->value = pose;
    const TargetReport& report = pipeline
                                     .process({.stamp = i * 100 * ms,
                                               .depth = wall.view(),
                                               .joints = positions_,
                                               .targets = {&target, 1}})
                                     .targets[0];
    ASSERT_EQ(report.estimate, penumbra::Outcome::accepted) << report.reason;
    // The camera is 0.25 m beside and 1.2 m before the slab, which is 1 m + slide from the root.
    const Eigen::Vector3d expected(0.25, 0.0, 1.0 - 1.2 + 2.0);
    EXPECT_LT((*report.handled->position - expected).norm(), 1e-6);
  }
}

/// Not even where it is of a frame that was judged before.
TEST_F(TargetsTest, EstimatesInAnUnknownFrameAreRefused) {
  Target target = region("a", beside_slab);
  target.handling = PointTrackerConfig{};
  judge(1 * ms, target);
  target.estimate =
      TargetEstimate{.value = Eigen::Vector3d(0, 0, 1), .stamp = 1 * ms, .frame = "arm"};
  const TargetReport& report = judge(2 * ms, target);
  EXPECT_EQ(report.verdict, Verdict::unknown);
  EXPECT_NE(report.reason.find("'arm'"), std::string_view::npos) << report.reason;
  EXPECT_EQ(report.estimate, Outcome::refused_invalid);
}

TEST_F(TargetsTest, WithoutStampsNothingIsHandled) {
  const Target target = followed(beside_slab);
  const FrameReport& report = pipeline_.process(
      {.stamp = {}, .depth = depth_.view(), .joints = positions_, .targets = {&target, 1}});
  EXPECT_EQ(report.targets[0].verdict, Verdict::visible);
  EXPECT_FALSE(report.targets[0].handled);
}

TEST_F(TargetsTest, AForgottenTargetStartsAnew) {
  judge(0, followed(beside_slab));
  pipeline_.forget_target("hand");
  EXPECT_EQ(judge(100 * ms, followed(behind_slab)).handled->source, Source::lost);
  judge(200 * ms, followed(beside_slab));
  EXPECT_EQ(judge(-7000 * ms, followed(behind_slab)).handled->source, Source::lost)
      << "a clock that is set back begins a new sequence";
}

// ---- Late targets

/// In the raw image of a lens a rendered box covers the pixels whose rays meet it, and the robot
/// hides those whose rays meet the robot.
TEST(TargetsInTheRawImage, OfARenderedBoxAreThoseThatTheirRaysMeet) {
  Camera camera = slab_camera();
  const double coefficients[] = {-0.25, 0.06, 0.001, -0.001, 0.0};
  camera.distortion = Distortion("plumb_bob", coefficients);
  const Image<float> depth = scene_depth(camera, 0.0);
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const Eigen::Vector3d middle(0.40, 0.05, 1.5), size(0.6, 0.5, 0.001);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = middle;
  const Target target{.name = "plate", .shape = BoxTarget{pose, size, {}}};
  const std::vector<double> positions{0.0};
  const FrameReport& report = pipeline.process(
      {.stamp = 1, .depth = depth.view(), .joints = positions, .targets = {&target, 1}});
  int covered = 0, hidden = 0;
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      const Eigen::Vector3d straight = camera.intrinsics.ray(u, v);
      const auto ray = camera.distortion.undistort(straight.head<2>());
      if (!ray) continue;
      const Eigen::Vector2d off = 1.4995 * *ray - middle.head<2>();
      if (std::abs(off.x()) > size.x() / 2 || std::abs(off.y()) > size.y() / 2) continue;
      ++covered;
      if (cast({ray->x(), ray->y(), 1.0}, 0.0).depth > 0.0) ++hidden;
    }
  }
  // Raw images are drawn through the pinhole image: outlines may be off by a pixel.
  const TargetReport& plate = report.targets[0];
  ASSERT_TRUE(plate.judgement) << plate.reason;
  constexpr double outline = 0.04;  // of the plate's pixels
  EXPECT_GT(covered, 1500);
  EXPECT_GT(hidden, 300);
  EXPECT_NEAR(static_cast<double>(plate.judgement->inside), covered, outline * covered);
  EXPECT_NEAR(plate.judgement->occluded, hidden / (1.0 * covered), outline);
  EXPECT_EQ(plate.verdict, Verdict::partial);
}

class LateTargetsTest : public TargetsTest {
 protected:
  LateTargetsTest() : TargetsTest(0.5) {}

  /// The slab stands at `slide` at that stamp.
  const FrameReport& frame_at(std::int64_t stamp, double slide, std::span<const Target> targets) {
    positions_[0] = slide;
    depth_ = scene_depth(slab_camera(), slide);
    return process(stamp, targets);
  }
};

Target late(const char* name, std::int64_t stamp, Extent extent = Extent::amodal) {
  // Beside the slab at slide 0, behind it at slide -0.3.
  return {.name = name, .shape = RegionTarget{{PixelBox{101, 47, 5, 8}}, extent}, .stamp = stamp};
}

TEST_F(LateTargetsTest, AreJudgedOnTheFrameOfTheirStamp) {
  frame_at(0, 0.0, {});
  frame_at(100 * ms, -0.3, {});
  frame_at(200 * ms, 0.0, {});
  const std::vector<Target> targets{late("first", 0), late("second", 100 * ms),
                                    late("now", 300 * ms), late("never", 150 * ms)};
  const FrameReport& report = frame_at(300 * ms, 0.0, targets);
  EXPECT_EQ(report.targets[0].verdict, Verdict::visible) << report.targets[0].reason;
  EXPECT_EQ(report.targets[1].verdict, Verdict::hidden) << report.targets[1].reason;
  EXPECT_EQ(report.targets[2].verdict, Verdict::visible);
  EXPECT_EQ(report.targets[3].verdict, Verdict::unknown);
  EXPECT_NE(report.targets[3].reason.find("no frame of its stamp"), std::string_view::npos);
  EXPECT_EQ(report.targets[1].stamp, 100 * ms);
}

TEST_F(LateTargetsTest, SeeWhatTheLiveFrameSaw) {
  std::vector<Judgement> live;
  std::vector<std::optional<Eigen::Vector3d>> points;
  for (int i = 0; i < 5; ++i) {
    const Target target = region("live", PixelBox{100, 40, 30, 40});
    const FrameReport& report = frame_at(i * 50 * ms, -0.05 * i, {&target, 1});
    live.push_back(*report.targets[0].judgement);
    points.push_back(report.targets[0].point);
  }
  for (int i = 0; i < 4; ++i) {
    Target target = region("late", PixelBox{100, 40, 30, 40});
    target.stamp = i * 50 * ms;
    const TargetReport& report = frame_at(200 * ms, -0.2, {&target, 1}).targets[0];
    ASSERT_TRUE(report.judgement) << report.reason;
    EXPECT_EQ(report.judgement->occluded, live[static_cast<std::size_t>(i)].occluded);
    EXPECT_EQ(report.judgement->clear, live[static_cast<std::size_t>(i)].clear);
    EXPECT_EQ(report.point, points[static_cast<std::size_t>(i)]);
  }
}

/// A detector 100 ms late, with every kind of target: what is said of each frame is the same, and
/// so are verdicts with their hysteresis and the accepted estimates.
TEST_F(LateTargetsTest, SayWhatTargetsInTimeDo) {
  PipelineConfig config = plain_config();
  Pipeline in_time(slab_robot(), slab_camera(), config);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.5, 0.0, 1.6);
  Image<std::uint8_t> mask(depth_.width(), depth_.height());
  for (int u = 96; u < 112; ++u) mask(u, 50) = mask(u, 51) = 1;
  std::vector<Target> targets{region("box", PixelBox{98, 46, 22, 9}),
                              region("mask", PixelMask{mask.view()}),
                              {.name = "keypoint", .shape = KeypointTarget{.pixel = {104, 56}}},
                              {.name = "point", .shape = PointTarget{{0.5, 0.0, 1.6}, 0.03, ""}},
                              {.name = "solid", .shape = BoxTarget{pose, {0.1, 0.1, 0.1}, "base"}}};
  targets[2].handling = PointTrackerConfig{};
  targets[4].handling = PoseTrackerConfig{};
  constexpr int frames = 12, delay = 2;
  std::vector<std::vector<TargetReport>> said(frames);
  const auto slide = [](int i) { return -0.4 * std::abs(std::sin(0.5 * i)); };
  for (int i = 0; i < frames; ++i) {
    positions_[0] = slide(i);
    depth_ = scene_depth(slab_camera(), slide(i));
    const auto& reports = in_time
                              .process({.stamp = i * 50 * ms,
                                        .depth = depth_.view(),
                                        .joints = positions_,
                                        .targets = targets})
                              .targets;
    said[static_cast<std::size_t>(i)].assign(reports.begin(), reports.end());
  }
  std::size_t changes = 0;
  for (int i = 0; i < frames + delay; ++i) {
    for (Target& target : targets) target.stamp = (i - delay) * 50 * ms;
    const FrameReport& report =
        frame_at(i * 50 * ms, slide(i), i < delay ? std::span<const Target>() : targets);
    if (i < delay) continue;
    const auto frame = static_cast<std::size_t>(i - delay);
    for (std::size_t j = 0; j < targets.size(); ++j) {
      const TargetReport &late = report.targets[j], &live = said[frame][j];
      SCOPED_TRACE(std::string(live.name) + ", frame " + std::to_string(frame));
      EXPECT_EQ(late.verdict, live.verdict) << late.reason;
      ASSERT_TRUE(late.judgement && live.judgement) << late.reason;
      EXPECT_EQ(late.judgement->inside, live.judgement->inside);
      EXPECT_EQ(late.judgement->occluded, live.judgement->occluded);
      EXPECT_EQ(late.judgement->unknown, live.judgement->unknown);
      EXPECT_EQ(late.judgement->hidden_by_other, live.judgement->hidden_by_other);
      EXPECT_EQ(late.point, live.point);
      EXPECT_EQ(late.estimate, live.estimate);
      if (frame > 0 && live.verdict != said[frame - 1][j].verdict) ++changes;
    }
  }
  EXPECT_GT(changes, 5U) << "the slab comes and goes";
}

TEST_F(LateTargetsTest, FramesBeyondTheSpanAreGone) {
  for (int i = 0; i < 20; ++i) frame_at(i * 100 * ms, 0.0, {});
  const std::vector<Target> targets{late("old", 200 * ms), late("young", 1500 * ms)};
  const FrameReport& report = frame_at(2000 * ms, 0.0, targets);
  EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
  EXPECT_EQ(report.targets[1].verdict, Verdict::visible);
}

TEST_F(LateTargetsTest, AFrameWithoutDepthStaysUnknown) {
  pipeline_.process({.stamp = 0, .depth = {}, .joints = positions_});
  const Target target = late("target", 0);
  const TargetReport& report = frame_at(100 * ms, 0.0, {&target, 1}).targets[0];
  EXPECT_EQ(report.verdict, Verdict::unknown);
  EXPECT_EQ(report.reason, "missing_depth: no depth image");
}

/// Hysteresis is of the order of stamps: one that goes back neither sees nor changes it.
TEST_F(LateTargetsTest, StampsThatGoBackLeaveHysteresisAlone) {
  // At slide 0 the slab hides 1 of 22 columns, 4.5 %: between the thresholds of leave and enter.
  const auto target = [](std::int64_t stamp) {
    Target made = region("edge", PixelBox{98, 46, 22, 9});
    made.stamp = stamp;
    return made;
  };
  const Target first = target(0), second = target(100 * ms);
  frame_at(0, 0.0, {&first, 1});
  const Verdict before = frame_at(100 * ms, -0.3, {&second, 1}).targets[0].verdict;
  ASSERT_EQ(before, Verdict::partial);
  const Target back = target(0), next = target(200 * ms);
  EXPECT_EQ(frame_at(200 * ms, 0.0, {&back, 1}).targets[0].verdict, Verdict::visible)
      << "judged as if for the first time";
  EXPECT_EQ(frame_at(200 * ms, 0.0, {&next, 1}).targets[0].verdict, Verdict::partial)
      << "it has not left that yet";
}

TEST_F(LateTargetsTest, AModalTargetIsJudgedInOrderOnly) {
  frame_at(0, 0.0, {});
  const Target now = late("mask", 100 * ms, Extent::modal);
  EXPECT_NE(frame_at(100 * ms, 0.0, {&now, 1}).targets[0].reason.find("robot"),
            std::string_view::npos);
  const Target back = late("mask", 0, Extent::modal);
  const TargetReport& report = frame_at(200 * ms, 0.0, {&back, 1}).targets[0];
  EXPECT_EQ(report.verdict, Verdict::unknown);
}

TEST(TargetHistory, OutsideOfItsBoundsIsRefused) {
  PipelineConfig config = plain_config();
  for (const double seconds : {-1.0, 61.0, std::numeric_limits<double>::quiet_NaN()}) {
    config.target_history = seconds;
    EXPECT_THROW(Pipeline(slab_robot(), slab_camera(), config), InputError);
  }
}

}  // namespace
}  // namespace penumbra::test
