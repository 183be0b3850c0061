// SPDX-License-Identifier: Apache-2.0
#include "targets_fixture.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/primitives.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::test {
namespace {

/// Depths are float32 metres of about 1.
constexpr double depth_rounding = 1e-5;

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
  EXPECT_EQ(hidden.judgement->blame[0].name, "slab");
  EXPECT_FALSE(hidden.point) << "its depth is the robot's";
  EXPECT_EQ(report.targets[1].verdict, Verdict::visible);
  ASSERT_TRUE(report.targets[1].point);
  EXPECT_NEAR(report.targets[1].point->z(), wall_depth, depth_rounding);
  EXPECT_EQ(report.targets[2].verdict, Verdict::out_of_view);
}

/// A link's frame, the root's and the camera's name the same place.
TEST_F(TargetsTest, SolidsAreSeenAlikeFromEveryFrame) {
  positions_[0] = 0.1;
  depth_ = scene_depth(slab_camera(), 0.1);
  const Eigen::Vector3d before(0.02, 0.01, 0.5);
  const Eigen::Vector2d at = slab_camera().intrinsics.project(before);
  for (int v = -6; v <= 6; ++v)
    for (int u = -6; u <= 6; ++u)
      depth_(static_cast<int>(at.x()) + u, static_cast<int>(at.y()) + v) = 0.5F;
  Eigen::Isometry3d in_camera = Eigen::Isometry3d::Identity();
  in_camera.translation() = Eigen::Vector3d(0.02, 0.01, 1.6);
  Eigen::Isometry3d in_slab = in_camera;
  in_slab.translation().z() -= 1.1;
  const auto mesh = std::make_shared<const PreparedMesh>(make_box({0.1, 0.1, 0.1}));
  const std::vector<Target> targets{
      {.name = "camera", .shape = BoxTarget{in_camera, {0.1, 0.1, 0.1}, {}}},
      {.name = "root", .shape = BoxTarget{in_camera, {0.1, 0.1, 0.1}, ReferenceFrame::root()}},
      {.name = "link",
       .shape = BoxTarget{in_slab, {0.1, 0.1, 0.1}, ReferenceFrame::of_link("slab")}},
      {.name = "mesh", .shape = MeshTarget{mesh, in_camera, {}}},
      {.name = "before", .shape = PointTarget{before, 0.02, ReferenceFrame::root()}},
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
  Frame frame{.stamp = 1, .depth = {}, .pose = {.positions = positions_}, .targets = {target}};
  const auto reason_of = [&](FrameStatus status) {
    const FrameReport& report = pipeline_.process(frame);
    EXPECT_EQ(report.status, status);
    EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
    EXPECT_FALSE(report.targets[0].judgement);
    return std::string(report.targets[0].reason);
  };
  EXPECT_EQ(reason_of(FrameStatus::missing_depth), "missing_depth: no depth image");
  frame.depth = depth_.view();
  frame.pose.positions.clear();
  EXPECT_NE(reason_of(FrameStatus::missing_joints).find("missing_joints"), std::string::npos);
}

/// The model alone says so: the rest was not looked at.
TEST_F(TargetsTest, WithoutDepthWhatTheRobotHidesIsHidden) {
  PoseTrackerConfig any;
  any.worst = Verdict::hidden;
  const PixelBox half_behind{88, 50, 20, 12};
  std::vector<Target> targets{
      {.name = "hidden", .shape = RegionTarget{behind_slab, Extent::amodal, 2.0}},
      {.name = "beside", .shape = RegionTarget{beside_slab, Extent::amodal, 2.0}},
      {.name = "before", .shape = RegionTarget{behind_slab, Extent::amodal, 0.5}},
      {.name = "half", .shape = RegionTarget{half_behind, Extent::amodal, 2.0}},
      {.name = "point", .shape = PointTarget{{0.02, 0.01, 1.6}, 0.02, ReferenceFrame::root()}}};
  for (Target& target : targets) {
    target.handling = any;
    target.thresholds.unknown_limit = 1;
  }
  targets[0].estimate = TargetEstimate{.frame = ReferenceFrame::root()};
  const FrameReport& report = pipeline_.process(
      {.stamp = 1, .depth = {}, .pose = {.positions = positions_}, .targets = targets});
  ASSERT_EQ(report.status, FrameStatus::missing_depth);
  EXPECT_EQ(report.targets[0].verdict, Verdict::hidden) << report.targets[0].reason;
  EXPECT_EQ(report.targets[0].judgement->occluded, 1.0);
  EXPECT_FALSE(report.targets[0].judgement->hidden_by_other);
  EXPECT_EQ(report.targets[0].estimate, penumbra::Outcome::refused_verdict);
  for (const std::size_t i : {1U, 2U, 3U}) {
    EXPECT_EQ(report.targets[i].verdict, Verdict::unknown) << i;
    EXPECT_EQ(report.targets[i].reason, "missing_depth: no depth image");
    EXPECT_EQ(report.targets[i].judgement->clear + report.targets[i].judgement->front, 0.0);
    EXPECT_FALSE(report.targets[i].point);
  }
  EXPECT_EQ(report.targets[4].verdict, Verdict::hidden);
}

/// Half a millimetre is a thirtieth of a pixel there.
TEST_F(TargetsTest, TinySolidsCoverThePixelNextToThem) {
  Eigen::Isometry3d beside = Eigen::Isometry3d::Identity();
  beside.translation() = wall_depth * slab_camera().intrinsics.ray(20.3, 85.3);
  Eigen::Isometry3d behind = Eigen::Isometry3d::Identity();
  behind.translation() = 2.0 * slab_camera().intrinsics.ray(70.3, 56.3);
  Eigen::Isometry3d outside = Eigen::Isometry3d::Identity();
  outside.translation() = 2.0 * slab_camera().intrinsics.ray(-3.0, 56.3);
  const Eigen::Vector3d size(0.0005, 0.0005, 0.0005);
  TriangleMesh box = make_box(size);
  for (Eigen::Vector3f& vertex : box.vertices) vertex.x() += 0.1F;
  const auto mesh = std::make_shared<PreparedMesh>(box);
  Eigen::Isometry3d mesh_pose = behind;
  mesh_pose.translation().x() -= 0.1;
  const std::vector<Target> targets{
      {.name = "beside", .shape = BoxTarget{beside, size, {}}},
      {.name = "behind", .shape = BoxTarget{behind, size, {}}},
      {.name = "mesh", .shape = MeshTarget{mesh, mesh_pose, {}}},
      {.name = "outside", .shape = BoxTarget{outside, size, {}}},
      {.name = "sheet", .shape = BoxTarget{behind, {0.3, 0.0001, 0.0001}, {}}}};
  const FrameReport& report = process(1, targets);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(report.targets[i].judgement) << report.targets[i].reason;
    EXPECT_EQ(report.targets[i].judgement->inside, 1U) << i;
  }
  EXPECT_EQ(report.targets[0].verdict, Verdict::visible) << report.targets[0].reason;
  EXPECT_EQ(report.targets[1].verdict, Verdict::hidden);
  EXPECT_EQ(report.targets[2].verdict, Verdict::hidden);
  EXPECT_EQ(report.targets[3].verdict, Verdict::out_of_view);
  EXPECT_EQ(report.targets[4].verdict, Verdict::unknown);
  EXPECT_NE(report.targets[4].reason.find("too thin"), std::string_view::npos);
}

TEST_F(TargetsTest, FaultsOfATargetAreItsReason) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Isometry3d bent = Eigen::Isometry3d::Identity();
  bent.linear() *= 1.1;
  const std::vector<Eigen::Vector2d> line{{10, 10}, {50, 50}, {30, 30}};
  const Image<std::uint8_t> small(7, 7, 1);
  TargetThresholds wrong, inside;
  wrong.partial_enter = 2.0;
  inside.min_inside = 0.5;
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
      {region("d", PixelPolygon{line}), "area"},
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
      {{.name = "r", .shape = PointTarget{{0, 0, 1}, 0.1, ReferenceFrame::of_link("arm")}},
       "not a link"},
      {{.name = "s", .shape = BoxTarget{bent, {0.1, 0.1, 0.1}, {}}}, "rigid"},
      {{.name = "t", .shape = BoxTarget{Eigen::Isometry3d::Identity(), {0.1, 0, 0.1}, {}}}, ""},
      {{.name = "u", .shape = MeshTarget{}}, "triangles"},
      {{.name = "v",
        .shape = BoxTarget{Eigen::Isometry3d::Identity(), {0.1, 0.1, 0.1}, {}},
        .thresholds = inside},
       "min_inside"},
      {{.name = "w",
        .has_identity = false,
        .shape = RegionTarget{beside_slab},
        .handling = PointTrackerConfig{}},
       "identity"}};
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

TEST_F(TargetsTest, KeypointsInMetresTakeTheDepthAtTheirPixel) {
  KeypointTarget shape{.pixel = {20, 85}, .semi_axes = {0.3, 0.3}, .in_metres = true};
  const TargetReport& report = judge(1, {.name = "k", .shape = shape});
  const double radius = 0.3 * 120.3 / wall_depth;
  EXPECT_NEAR(static_cast<double>(report.judgement->covered), std::numbers::pi * radius * radius,
              2.0 * std::numbers::pi * radius * 0.5);
  depth_(20, 85) = 0.0F;
  EXPECT_NE(judge(2, {.name = "k", .shape = shape}).reason.find("no depth"),
            std::string_view::npos);
}

/// A detector's two cups, named by their place in its message, which goes by score. A large one
/// that the slab hides half would be taken for the small one, seen whole.
TEST_F(TargetsTest, ANameOfNoObjectRemembersNone) {
  const PixelBox large{5, 92, 36, 20}, small{142, 105, 12, 8};
  const PixelBox remnant{28, 47, 20, 20};  // what is left of the large one beside the slab
  std::int64_t stamp = 0;
  const auto verdicts = [&](bool has_identity, const PixelBox& first, const PixelBox& second) {
    std::vector<Target> targets{
        {.name = "cup", .shape = RegionTarget{first, Extent::modal, 2.0}},
        {.name = "cup 2", .shape = RegionTarget{second, Extent::modal, 2.0}}};
    for (Target& target : targets) {
      target.has_identity = has_identity;
      target.thresholds.past_limit = 1;  // the model alone says it
      target.thresholds.min_measured = 0;
    }
    const FrameReport& report = process(stamp += 33 * ms, targets);
    return std::pair(report.targets[0].verdict, report.targets[1].verdict);
  };
  const auto both = [](Verdict first, Verdict second) { return std::pair(first, second); };
  EXPECT_EQ(verdicts(false, large, small), both(Verdict::visible, Verdict::visible));
  EXPECT_EQ(verdicts(false, remnant, small), both(Verdict::unknown, Verdict::visible));
  EXPECT_EQ(verdicts(false, large, small), both(Verdict::visible, Verdict::visible));
  EXPECT_EQ(verdicts(false, small, remnant), both(Verdict::visible, Verdict::unknown));
  EXPECT_EQ(verdicts(false, small, large), both(Verdict::visible, Verdict::visible));
  EXPECT_EQ(verdicts(true, remnant, small), both(Verdict::unknown, Verdict::visible));
  EXPECT_EQ(verdicts(true, large, small), both(Verdict::visible, Verdict::visible));
  // A name that jumps to another place is another object's.
  EXPECT_EQ(verdicts(true, small, remnant).second, Verdict::unknown);
}

/// Balls all over the image against the rays that meet them.
TEST_F(TargetsTest, ABallCoversThePixelsWhoseRaysMeetIt) {
  const Intrinsics k = slab_camera().intrinsics;
  constexpr double radius = 0.25;
  constexpr double edge = 0.03;  // of the pixels: those whose centres lie on the outline
  for (const double x : {-1.0, -0.4, 0.0, 0.8})
    for (const double y : {-0.6, 0.0, 0.5}) {
      const Eigen::Vector3d middle(x, y, 1.6);
      std::size_t pixels = 0;
      for (int v = -k.height(); v < 2 * k.height(); ++v)  // covered are those outside, too
        for (int u = -k.width(); u < 2 * k.width(); ++u)
          pixels += k.ray(u, v).normalized().cross(middle).norm() <= radius;
      const TargetReport& report =
          judge(1, {.name = "ball", .shape = PointTarget{middle, radius, {}}});
      ASSERT_TRUE(report.judgement) << report.reason;
      EXPECT_NEAR(static_cast<double>(report.judgement->covered), static_cast<double>(pixels),
                  edge * static_cast<double>(pixels))
          << x << ' ' << y;
    }
}

/// The robot's depth would make the ellipse larger, and what is hidden a smaller share of it.
TEST_F(TargetsTest, KeypointsInMetresDoNotTakeTheRobotsDepth) {
  KeypointTarget shape{.pixel = {70, 56}, .semi_axes = {0.05, 0.05}, .in_metres = true};
  const TargetReport& report = judge(1, {.name = "k", .shape = shape});
  EXPECT_EQ(report.verdict, Verdict::unknown);
  EXPECT_NE(report.reason.find("the robot's"), std::string_view::npos) << report.reason;
  shape.expected_depth = 2.0;
  EXPECT_EQ(judge(2, {.name = "k", .shape = shape}).verdict, Verdict::hidden);
}

}  // namespace
}  // namespace penumbra::test
