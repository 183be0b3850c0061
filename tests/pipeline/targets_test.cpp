// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <penumbra/mesh/primitives.hpp>

namespace penumbra::test {
namespace {

/// Depths are float32 metres of about 1.
constexpr double depth_rounding = 1e-5;

TEST_F(TargetsTest, AreJudgedWhereTheySee) {
  const FrameReport& report =
      process(1, {region("hidden", behind_slab), region("clear", beside_slab),
                  region("outside", PixelBox{400, 400, 9, 9})});
  expect_verdicts(report, {Verdict::hidden, Verdict::visible, Verdict::out_of_view});
  EXPECT_TRUE(report.timing.targets);
  const TargetReport& hidden = report.targets[0];
  EXPECT_EQ(hidden.name, "hidden");
  EXPECT_EQ(hidden.judgement->inside, 240U);
  EXPECT_EQ(hidden.judgement->occluded, 1.0);
  ASSERT_EQ(hidden.judgement->blame.size(), 1U);
  EXPECT_EQ(hidden.judgement->blame[0].name, "slab");
  EXPECT_FALSE(hidden.point) << "its depth is the robot's";
  ASSERT_TRUE(report.targets[1].point);
  EXPECT_NEAR(report.targets[1].point->z(), wall_depth, depth_rounding);
}

/// A link's frame, the root's and the camera's name the same place.
TEST_F(TargetsTest, SolidsAreSeenAlikeFromEveryFrame) {
  positions_[0] = 0.1;
  depth_ = scene_depth(slab_camera(), 0.1);
  const Vector3d before(0.02, 0.01, 0.5), size(0.1, 0.1, 0.1);
  const Eigen::Vector2i pixel = slab_camera().intrinsics.project(before).cast<int>();
  for (const auto [u, v] : each_pixel(-6, -6, 7, 7)) depth_(pixel.x() + u, pixel.y() + v) = 0.5F;
  const Isometry3d in_camera = at(0.02, 0.01, 1.6), in_slab = at(0.02, 0.01, 0.5);
  const auto mesh = std::make_shared<const PreparedMesh>(make_box(size));
  const FrameReport& report = process(
      1, {{.name = "camera", .shape = BoxTarget{in_camera, size, {}}},
          {.name = "root", .shape = BoxTarget{in_camera, size, ReferenceFrame::root()}},
          {.name = "link", .shape = BoxTarget{in_slab, size, ReferenceFrame::of_link("slab")}},
          {.name = "mesh", .shape = MeshTarget{mesh, in_camera, {}}},
          {.name = "before", .shape = PointTarget{before, 0.02, ReferenceFrame::root()}},
          {.name = "behind", .shape = PointTarget{{0.02, 0.01, 1.6}, 0.02, {}}}});
  using enum Verdict;
  expect_verdicts(report, {hidden, hidden, hidden, hidden, visible, hidden});
  const std::size_t covered = report.targets[0].judgement->covered;
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(report.targets[i].judgement->covered, covered);
  // The near face at 1.55 m, 0.1 m wide.
  EXPECT_NEAR(double(covered), 0.1 * 120.3 / 1.55 * 0.1 * 118.7 / 1.55, 10.0);
}

/// The model alone says so: the rest was not looked at.
TEST_F(TargetsTest, WithoutDepthWhatTheRobotHidesIsHidden) {
  const PixelBox half_behind{88, 50, 20, 12};
  std::vector<Target> targets{
      {.name = "hidden", .shape = RegionTarget{behind_slab, Extent::amodal, 2.0}},
      {.name = "beside", .shape = RegionTarget{beside_slab, Extent::amodal, 2.0}},
      {.name = "before", .shape = RegionTarget{behind_slab, Extent::amodal, 0.5}},
      {.name = "half", .shape = RegionTarget{half_behind, Extent::amodal, 2.0}},
      {.name = "point", .shape = PointTarget{{0.02, 0.01, 1.6}, 0.02, ReferenceFrame::root()}}};
  for (Target& target : targets) {
    target.handling = PoseTrackerConfig{.worst = Verdict::hidden};
    target.thresholds.unknown_limit = 1;
  }
  targets[0].estimate = TargetEstimate{.frame = ReferenceFrame::root()};
  const FrameReport& report = pipeline_.process(
      {.stamp = 1, .depth = {}, .pose = {.positions = positions_}, .targets = targets});
  ASSERT_EQ(report.status, FrameStatus::missing_depth);
  using enum Verdict;
  expect_verdicts(report, {hidden, unknown, unknown, unknown, hidden});
  EXPECT_EQ(report.targets[0].judgement->occluded, 1.0);
  EXPECT_FALSE(report.targets[0].judgement->hidden_by_other);
  EXPECT_EQ(report.targets[0].estimate, Outcome::refused_verdict);
  for (const std::size_t i : {1U, 2U, 3U}) {
    EXPECT_TRUE(holds(report.targets[i].reason, "missing_depth"));
    EXPECT_EQ(report.targets[i].judgement->clear + report.targets[i].judgement->front, 0.0);
    EXPECT_FALSE(report.targets[i].point);
  }
}

/// Half a millimetre is a thirtieth of a pixel there.
TEST_F(TargetsTest, TinySolidsCoverThePixelNextToThem) {
  const auto placed = [](double z, double u, double v) {
    return at(z * slab_camera().intrinsics.ray(u, v));
  };
  const Isometry3d behind = placed(2.0, 70.3, 56.3);
  const Vector3d size(0.0005, 0.0005, 0.0005);
  TriangleMesh box = make_box(size);
  for (Vector3f& vertex : box.vertices) vertex.x() += 0.1F;
  const auto mesh = std::make_shared<PreparedMesh>(box);
  const FrameReport& report =
      process(1, {{.name = "beside", .shape = BoxTarget{placed(wall_depth, 20.3, 85.3), size, {}}},
                  {.name = "behind", .shape = BoxTarget{behind, size, {}}},
                  {.name = "mesh", .shape = MeshTarget{mesh, at(-0.1, 0, 0) * behind, {}}},
                  {.name = "outside", .shape = BoxTarget{placed(2.0, -3.0, 56.3), size, {}}},
                  {.name = "sheet", .shape = BoxTarget{behind, {0.3, 0.0001, 0.0001}, {}}}});
  using enum Verdict;
  expect_verdicts(report, {visible, hidden, hidden, out_of_view, unknown});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(report.targets[i].judgement->inside, 1U) << i;
  EXPECT_TRUE(holds(report.targets[4].reason, "too thin"));
}

TEST_F(TargetsTest, FaultsOfATargetAreItsReason) {
  Isometry3d bent = Isometry3d::Identity();
  bent.linear() *= 1.1;
  const Isometry3d here = Isometry3d::Identity();
  const std::vector<Vector2d> line{{10, 10}, {50, 50}, {30, 30}};
  const Image<std::uint8_t> small(7, 7, 1);
  const RegionTarget free{beside_slab};
  const ReferenceFrame no_link = ReferenceFrame::of_link("arm");
  const std::pair<Target, const char*> cases[] = {
      {{.name = "a"}, "not found"},
      {region("", beside_slab), "no name"},
      {region("b", PixelBox{nan, 0, 5, 5}), ""},
      {region("c", PixelBox{5, 5, 0, 5}), ""},
      {region("d", PixelPolygon{line}), "area"},
      {region("e", PixelMask{small.view()}), ""},
      {{.name = "f", .shape = RegionTarget{beside_slab, Extent::amodal, -1.0}}, "expected depth"},
      {{.name = "g", .shape = free, .frame_id = "other"}, "image frame"},
      {{.name = "h", .shape = free, .stamp = 7}, "target_history"},
      {{.name = "i", .shape = free, .thresholds = {.partial_enter = 2.0, .unknown_limit = {}}},
       "partial_enter"},
      {{.name = "j", .shape = free, .handling = PoseTrackerConfig{.timeout = -1.0}}, "timeout"},
      {{.name = "k", .shape = free, .fault = "its file is bad"}, "its file is bad"},
      {{.name = "l", .shape = KeypointTarget{.pixel = {20, 85}, .score = 0.1, .min_score = 0.3}},
       "score 0.1 is below 0.3"},
      {{.name = "m", .shape = KeypointTarget{.pixel = {20, 85}, .score = nan}}, "score"},
      {{.name = "n", .shape = KeypointTarget{.pixel = {nan, 85}}}, "pixel"},
      {{.name = "o", .shape = KeypointTarget{.pixel = {20, 85}, .semi_axes = {0, 5}}}, "semi-axis"},
      {{.name = "p", .shape = PointTarget{{nan, 0, 1}, 0.02, {}}}, "position"},
      {{.name = "q", .shape = PointTarget{{0, 0, 1}, 0.0, {}}}, "radius"},
      {{.name = "r", .shape = PointTarget{{0, 0, 1}, 0.1, no_link}}, "not a link"},
      {{.name = "s", .shape = BoxTarget{bent, {0.1, 0.1, 0.1}, {}}}, "rigid"},
      {{.name = "t", .shape = BoxTarget{here, {0.1, 0, 0.1}, {}}}, ""},
      {{.name = "u", .shape = MeshTarget{}}, "triangles"},
      {{.name = "v",
        .shape = BoxTarget{here, {0.1, 0.1, 0.1}, {}},
        .thresholds = {.unknown_limit = {}, .min_inside = 0.5}},
       "min_inside"},
      {{.name = "w", .has_identity = false, .shape = free, .handling = PointTrackerConfig{}},
       "identity"}};
  for (const auto& [target, told] : cases) {
    const TargetReport& report = judge(1, target);
    EXPECT_EQ(report.verdict, Verdict::unknown) << target.name;
    EXPECT_NE(report.reason, "") << target.name;
    EXPECT_TRUE(holds(report.reason, told));
    EXPECT_FALSE(report.point);
  }
}

TEST_F(TargetsTest, NamesUsedTwiceAreBothUnknown) {
  const Target same = region("same", beside_slab);
  for (int i = 0; i < 2; ++i) {
    const FrameReport& report =
        process(i, {same, region("other", beside_slab), region("same", behind_slab)});
    expect_verdicts(report, {Verdict::unknown, Verdict::visible, Verdict::unknown});
    EXPECT_TRUE(holds(report.targets[2].reason, "twice"));
  }
  EXPECT_EQ(judge(3, same).verdict, Verdict::visible);
}

TEST_F(TargetsTest, KeypointsInMetresTakeTheDepthAtTheirPixelUnlessItIsTheRobots) {
  const KeypointTarget shape{.pixel = {20, 85}, .semi_axes = {0.3, 0.3}, .in_metres = true};
  const TargetReport& report = judge(1, {.name = "k", .shape = shape});
  const double radius = 0.3 * 120.3 / wall_depth;
  EXPECT_NEAR(double(report.judgement->covered), std::numbers::pi * radius * radius,
              2.0 * std::numbers::pi * radius * 0.5);
  depth_(20, 85) = 0.0F;
  EXPECT_TRUE(holds(judge(2, {.name = "k", .shape = shape}).reason, "no depth"));

  // The robot's depth would make the ellipse larger, and what is hidden a smaller share of it.
  KeypointTarget behind{.pixel = {70, 56}, .semi_axes = {0.05, 0.05}, .in_metres = true};
  const TargetReport& unknown = judge(3, {.name = "k", .shape = behind});
  EXPECT_EQ(unknown.verdict, Verdict::unknown);
  EXPECT_TRUE(holds(unknown.reason, "the robot's"));
  behind.expected_depth = 2.0;
  EXPECT_EQ(judge(4, {.name = "k", .shape = behind}).verdict, Verdict::hidden);
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
      const Vector3d middle(x, y, 1.6);
      std::size_t pixels = 0;
      for (int v = -k.height(); v < 2 * k.height(); ++v)  // covered are those outside, too
        for (int u = -k.width(); u < 2 * k.width(); ++u)
          pixels += k.ray(u, v).normalized().cross(middle).norm() <= radius;
      const TargetReport& report =
          judge(1, {.name = "ball", .shape = PointTarget{middle, radius, {}}});
      ASSERT_TRUE(report.judgement) << report.reason;
      EXPECT_NEAR(double(report.judgement->covered), double(pixels), edge * double(pixels))
          << x << ' ' << y;
    }
}

}  // namespace
}  // namespace penumbra::test
