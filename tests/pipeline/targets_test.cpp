// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <penumbra/mesh/primitives.hpp>

namespace penumbra::test {
namespace {

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

// Where the sensor measures nothing, or in or near links that are not drawn.

class TargetsWithinARange : public TargetsTest {
 protected:
  TargetsWithinARange() {
    Camera camera = slab_camera();
    camera.range = {0.3, 1.6};
    pipeline_ = Pipeline(slab_robot(), camera, plain_config());
  }
};

Target box_at(double depth, double depth_margin) {
  return {.name = "box",
          .shape = BoxTarget{at(depth * slab_camera().intrinsics.ray(20, 85)), {0.1, 0.1, 0.1}, {}},
          .depth_margin = depth_margin,
          .handling = PoseTrackerConfig{}};
}

/// The wall behind it is out of range.
TEST_F(TargetsWithinARange, ThinAirIsNotVisibleAndItsPoseNotTaken) {
  const TargetReport& report = judge(1 * ms, box_at(1.3, 0.02));
  EXPECT_EQ(report.verdict, Verdict::unknown);
  EXPECT_EQ(report.judgement->measured, 0.0);
  EXPECT_TRUE(holds(report.reason, "measured"));
  EXPECT_EQ(report.estimate, Outcome::refused_verdict);
  EXPECT_EQ(report.handled->source, Source::lost);
}

/// Three of ten pixels of a dark object are holes.
TEST_F(TargetsWithinARange, AnObjectWithHolesIsVisibleAndItsPoseTaken) {
  for (const auto [u, v] : each_pixel(0, 65, 40, 105))
    depth_(u, v) = (u + 3 * v) % 10 < 3 ? 0.0F : 1.25F;
  const TargetReport& report = judge(1 * ms, box_at(1.3, 0.1));  // its near face is measured
  EXPECT_EQ(report.verdict, Verdict::visible) << report.reason;
  EXPECT_NEAR(*report.judgement->measured, 0.7, 0.05);
  EXPECT_EQ(report.estimate, Outcome::accepted);
  EXPECT_EQ(report.handled->source, Source::measured);
  EXPECT_TRUE(report.point);
}

/// It is not hidden by the robot; what a detector says of it was not seen by the sensor.
TEST_F(TargetsWithinARange, NoEstimateIsTakenWhereNothingIsMeasured) {
  Target target = region("far", beside_slab);
  target.handling = PoseTrackerConfig{};
  target.estimate = TargetEstimate{.value = at(2.9 * slab_camera().intrinsics.ray(20, 85)),
                                   .frame = ReferenceFrame::root()};
  const TargetReport far = judge(1 * ms, target);
  EXPECT_EQ(far.verdict, Verdict::visible);
  EXPECT_FALSE(far.point);
  EXPECT_EQ(far.estimate, Outcome::refused_verdict);
  EXPECT_EQ(far.handled->source, Source::lost);
  target.thresholds.min_measured = 0.0;
  EXPECT_EQ(judge(2 * ms, target).estimate, Outcome::accepted) << "asked for";
}

TEST(TargetsWithoutALink, AreNeverVisible) {
  Pipeline pipeline(slab_robot_without_mesh(), slab_camera(), plain_config());
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  const PixelBox half_behind{40, 50, 20, 12}, outside{-50, 50, 20, 12};
  const FrameReport& report =
      pipeline.process(frame_of(depth, 0.0,
                                {region("clear", beside_slab), region("hidden", behind_slab),
                                 region("half", half_behind), region("outside", outside)}));
  ASSERT_EQ(report.status, FrameStatus::missing_link);
  EXPECT_TRUE(holds(report.message, "'lost'"));
  using enum Verdict;
  expect_verdicts(report, {unknown, hidden, unknown, out_of_view});  // half: its rest is not clear
  for (const std::size_t i : {0U, 2U}) EXPECT_TRUE(holds(report.targets[i].reason, "'lost'"));
  EXPECT_FALSE(report.targets[0].point) << "the link's own body may be there";
  EXPECT_EQ(report.targets[0].judgement->clear, 0.0);
  EXPECT_EQ(report.targets[0].judgement->unknown, 1.0);
  const Judgement& half = *report.targets[2].judgement;
  EXPECT_NEAR(half.occluded, 12.0 / 20.0, 1e-9);
  EXPECT_NEAR(half.unknown, 8.0 / 20.0, 1e-9);
  EXPECT_EQ(half.clear + half.front, 0.0);
}

TEST_F(TargetsTest, OfAnUncertainLinkAreUnknownInThatLinkAlone) {
  Frame frame = frame_of(depth_);
  for (const char* const link : {"plate", "slab", "base"})
    frame.targets.push_back({.name = link,
                             .shape = PointTarget{.position = {0.0, 0.0, 0.3},
                                                  .frame = ReferenceFrame::of_link(link)}});
  frame.pose.uncertain_links = {*slab_robot().find_link("plate")};
  frame.pose.uncertain_reason = "two publishers differ";
  const FrameReport& report = pipeline_.process(frame);
  EXPECT_EQ(report.status, FrameStatus::missing_link);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(report.targets[i].judgement.has_value(), i > 0) << i;
  EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
  EXPECT_TRUE(holds(report.targets[0].reason, {"'plate'", "two publishers differ"}));
  frame.pose.uncertain_links = {0};
  EXPECT_EQ(pipeline_.process(frame).status, FrameStatus::missing_transform)
      << "it carries the camera";
}

}  // namespace
}  // namespace penumbra::test
