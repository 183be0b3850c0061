// SPDX-License-Identifier: Apache-2.0
// Bodies that the robot's links carry, against boxes that a formula intersects.
#include "../support/opengl.hpp"
#include "slab_scene.hpp"

#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/pipeline/without_robot.hpp>

namespace penumbra::test {
namespace {

PENUMBRA_BACKEND_TEST(AttachedTo);

/// One on the root link is a fixture of the cell: it stands still.
TEST_P(AttachedTo, ALinkIsDrawnWhereTheFormulaTells) {
  const Camera camera = slab_camera();
  Pipeline pipeline(slab_robot(), camera, plain_config(GetParam()));
  const Vector3d post(-0.3, -0.1, 1.2);
  const std::vector<AttachedBody> all{part(), body("lid", "plate", {0.0, 0.0, -0.2}),
                                      body("post", "base", post)};
  for (const double slide : {0.0, 0.3, -0.2})
    for (const std::size_t count : {3U, 0U, 1U}) {
      std::vector<SlabBox> boxes{
          part_box(slide), {{0.5, 0.1, 1.3}, part_size, 5}, {post, part_size, 6}};
      boxes.resize(count);
      const Image<float> depth = scene_depth(camera, slide, boxes);
      Frame frame = frame_of(depth, slide, {}, all);
      frame.pose.attached.resize(count);
      const FrameReport& report = pipeline.process(frame);
      ASSERT_EQ(report.status, FrameStatus::ok) << report.message;
      ASSERT_EQ(report.attached.size(), count);
      expect_drawn(report.virtual_depth, [&](const auto& ray) { return cast(ray, slide, boxes); });
      for (const auto [u, v] : each_pixel(depth))
        ASSERT_EQ(report.labels(u, v) == int(Label::occluded),
                  report.virtual_depth.links(u, v) != 0);
      EXPECT_EQ(report.pixels.front + report.pixels.unknown, 0U);
      for (const std::size_t i : report.attached)
        EXPECT_EQ(report.links[i], all[i - slab_robot().links().size()].name);
    }
}

TEST(Attached, HidesATargetAndIsBlamed) {
  Pipeline pipeline(slab_robot(), slab_camera(), plain_config());
  const Image<float> depth = scene_depth(slab_camera(), 0.0, {part_box()});
  const FrameReport& report = pipeline.process(
      frame_of(depth, 0.0, {region("behind", behind_part), region("part", behind_part)}, {part()}));
  EXPECT_EQ(report.targets[1].verdict, Verdict::held) << "it does not hide itself";
  EXPECT_TRUE(holds(report.targets[1].reason, "'slab'"));
  EXPECT_EQ(report.targets[0].verdict, Verdict::hidden);
  ASSERT_EQ(report.targets[0].judgement->blame.size(), 1U);
  EXPECT_EQ(report.targets[0].judgement->blame[0].name, "part");
  DepthImage out;
  without_robot(report, out);
  const auto& rest = std::get<Image<float>>(out);
  for (const auto [u, v] : each_pixel(depth))
    ASSERT_EQ(std::isnan(rest(u, v)),
              cast(slab_camera().intrinsics.ray(u, v), 0.0, {part_box()}).link != 0);
}

TEST(Attached, ABodyThatCannotBeDrawnMakesNothingVisible) {
  Isometry3d sheared = Isometry3d::Identity();
  sheared.linear()(0, 1) = 0.5;
  AttachedBody no_mesh = part(), empty = part(), bent = part();
  no_mesh.mesh.reset();
  empty.mesh = std::make_shared<PreparedMesh>(TriangleMesh{});
  bent.T_link_body = sheared;
  Pipeline pipeline(slab_robot(), slab_camera(), plain_config());
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  for (const AttachedBody& wrong : {no_mesh, empty, bent, body("part", "no_link", {0, 0, 0})}) {
    const FrameReport& report =
        pipeline.process(frame_of(depth, 0.0, {region("free", PixelBox{5, 5, 6, 6})}, {wrong}));
    EXPECT_EQ(report.status, FrameStatus::missing_link);
    EXPECT_TRUE(holds(report.message, "'part'"));
    ASSERT_EQ(report.missing_links.size(), 1U);
    EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
    for (const std::uint8_t label : pixels_of(report.labels))
      ASSERT_TRUE(label == unknown_label || label == int(Label::occluded));
    EXPECT_EQ(report.pixels.occluded + report.pixels.unknown, depth.size());
    EXPECT_EQ(report.pixels.robot, report.pixels.occluded) << "of what is drawn";
    DepthImage out;
    without_robot(report, out);
    for (const auto [u, v] : each_pixel(depth)) ASSERT_TRUE(std::isnan(std::get<1>(out)(u, v)));
  }
  EXPECT_EQ(pipeline.process(frame_of(depth)).status, FrameStatus::ok);
}

TEST(Attached, ManyOneAfterAnotherKeepTheirNames) {
  Pipeline pipeline(slab_robot(), slab_camera(), plain_config());
  for (int i = 0; i < 200; ++i) {
    const std::vector<AttachedBody> attached{
        body("a" + std::to_string(i), "slab", {0.3, 0, 0}),
        body("b" + std::to_string(i / 50), "slab", {-0.3, 0, 0})};
    const FrameReport& report =
        pipeline.process({.pose = {.positions = {0.0}, .attached = attached}});
    ASSERT_EQ(report.attached.size(), 2U);
    for (const std::size_t k : {0U, 1U})
      ASSERT_EQ(report.links[report.attached[k]], attached[k].name);
    ASSERT_LE(report.links.size(), slab_robot().links().size() + max_attached);
  }
}

TEST(Attached, StaysWhenTheClockIsSetBack) {
  const Robot robot = slab_robot();
  PoseHistory history(robot);
  FrameQueue queue(robot, history, {.policy = DropPolicy::every});
  const std::string names[] = {"slide"};
  const double position[] = {0.0};
  history.add_joints(5400 * ms, names, position);
  history.attachments().attach(5500 * ms, part());
  history.add_joints(1100 * ms, names, position);
  queue.push({.stamp = 1100 * ms}, 0);
  const auto frame = queue.next(0);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->pose.attached.size(), 1U);
}

/// Against a model that looks at all changes every time, with late ones.
TEST(Attached, StampsDecideInAnyOrderOfMessages) {
  auto random = seeded_random(3);
  const auto below = [&](std::uint64_t end) { return std::int64_t(random() % end); };
  for (int trial = 0; trial < samples(50); ++trial) {
    Attachments attachments;
    std::map<std::int64_t, std::pair<std::string, bool>> changes;  // by stamp
    std::vector<AttachedBody> now;
    for (int step = 0; step < (trial == 0 ? 2500 : 400); ++step) {  // from 1000 on, some are merged
      const std::int64_t stamp = 10 * step - below(200);
      const std::string name(1, char('a' + below(4)));
      if (changes.contains(stamp)) continue;
      const bool is_attached = below(2) == 0;
      changes[stamp] = {name, is_attached};
      if (is_attached)
        attachments.attach(stamp, {.name = name, .link = "slab", .mesh = {}});
      else
        attachments.detach(stamp, name);
      const std::int64_t asked = 10 * step - below(300);
      std::map<std::string, bool> wanted;
      for (const auto& [at, change] : changes)
        if (at <= asked) wanted[change.first] = change.second;
      std::erase_if(wanted, [](const auto& each) { return !each.second; });
      attachments.at(asked, now);
      ASSERT_EQ(now.size(), wanted.size());
      for (const AttachedBody& each : now) ASSERT_TRUE(wanted.contains(each.name));
    }
  }
}

// Targets that a link picks up and puts down, against boxes that a formula intersects.

const Vector3d picked(0.19, 0.06, 0.92);  // of its centre, where the slab takes it
constexpr std::int64_t period = 33 * ms;
constexpr double exact = 1e-9;  // metres: a chain of a few rotations in double

Target cup(const Vector3d& at, TargetHandling handling = {}) {
  return {
      .name = "cup",
      .shape = BoxTarget{.pose = test::at(at), .size = part_size, .frame = ReferenceFrame::root()},
      .handling = std::move(handling)};
}

/// A cup that stands still, is carried by the slab, and stands where it was put down.
class Carrying : public testing::Test {
 protected:
  /// Judges a frame of the scene with the cup at `at` and the slab at `slide`.
  const FrameReport& see(const Target& target, double slide, const Vector3d& at) {
    const SlabBox box{at, part_size, attached_.empty() ? 0 : 4};
    depth_ = scene_depth(slab_camera(), slide, {box});
    Frame frame = frame_of(depth_, slide, {target}, attached_);
    frame.stamp = stamp_ += period;
    return pipeline_.process(frame);
  }

  Pipeline pipeline_{slab_robot(), slab_camera(), plain_config()};
  std::vector<AttachedBody> attached_;
  std::int64_t stamp_ = 0;
  Image<float> depth_;
};

TEST_F(Carrying, ATargetIsHeldWhereTheLinkTakesItAndJudgedAsNewAfterwards) {
  const PoseTrackerConfig handling{.motion = Motion::still};
  const Target found = cup(picked, handling);
  const FrameReport* report = nullptr;
  for (int i = 0; i < 5; ++i) report = &see(found, 1.0, picked);  // the slab is far behind
  ASSERT_EQ(report->targets[0].verdict, Verdict::visible) << report->targets[0].reason;
  see(found, 0.0, picked);
  attached_ = {pipeline_.attach_target(found, "slab")};

  for (const double slide : {0.0, 0.1, 0.3, 0.5}) {
    const Vector3d at = picked + slide * Vector3d::UnitZ();
    // Its given pose is still where it was picked up: that changes nothing.
    report = &see(found, slide, at);
    const TargetReport& target = report->targets[0];
    EXPECT_EQ(target.verdict, Verdict::held);
    EXPECT_TRUE(holds(target.reason, "'slab'"));
    EXPECT_FALSE(target.judgement);
    EXPECT_FALSE(target.point);
    EXPECT_EQ(target.estimate, Outcome::refused_verdict);
    ASSERT_TRUE(target.handled && target.handled->position && target.handled->orientation);
    EXPECT_EQ(target.handled->source, Source::predicted);
    EXPECT_EQ(target.handled->age, 0.0);
    EXPECT_LT((*target.handled->position - at).norm(), exact);
    EXPECT_LT(target.handled->orientation->angularDistance(Eigen::Quaterniond::Identity()), exact);
    EXPECT_EQ(report->pixels.front, 0U) << "it is drawn where it is";
  }

  attached_.clear();
  const Vector3d down = picked + 0.5 * Vector3d::UnitZ();
  Target absent = found;  // not found in this frame
  absent.shape = std::monostate();
  report = &see(absent, 0.7, down);
  ASSERT_TRUE(report->targets[0].handled->position);
  EXPECT_EQ(report->targets[0].handled->source, Source::held) << "the last position";
  EXPECT_LT((*report->targets[0].handled->position - down).norm(), exact);
  Target late = found;  // of the time at which it was not yet held
  late.estimate =
      TargetEstimate{.value = at(picked), .stamp = 3 * period, .frame = ReferenceFrame::root()};
  report = &see(late, 1.2, down);
  EXPECT_EQ(report->targets[0].estimate, Outcome::refused_late);
  report = &see(cup(down, handling), 1.2, down);
  EXPECT_EQ(report->targets[0].verdict, Verdict::visible) << report->targets[0].reason;
  EXPECT_EQ(report->targets[0].estimate, Outcome::accepted) << "no gate is in its way";
}

TEST_F(Carrying, APointBecomesItsBall) {
  const Vector3d at(-0.1, 0.05, 0.8), moved = at - Vector3d(0, 0, 0.5);
  Target ball = cup(at, PointTrackerConfig{});
  ball.shape = PointTarget{.position = at, .radius = 0.05};  // the camera is at the root
  ASSERT_EQ(see(ball, 1.0, at).targets[0].verdict, Verdict::visible);
  const AttachedBody body = pipeline_.attach_target(ball, "slab");
  EXPECT_EQ(body.name, "cup");
  EXPECT_EQ(body.link, "slab");
  EXPECT_LT((body.T_link_body.translation() - (at - Vector3d(0, 0, 2.0))).norm(), exact);
  EXPECT_NEAR(body.mesh->bounds.sizes().minCoeff(), 0.1, 2 * primitive_error);
  EXPECT_NEAR(body.mesh->bounds.sizes().maxCoeff(), 0.1, 2 * primitive_error);
  attached_ = {body};
  const TargetReport& target = see(ball, 0.5, moved).targets[0];
  EXPECT_LT((*target.handled->position - moved).norm(), exact);
  EXPECT_FALSE(target.handled->orientation);
}

/// The pose in a link that turns, given in any frame, with handling and without.
TEST(AttachTarget, TurnsWithTheLink) {
  const Robot robot = parse(
      slab_urdf(link_xml("arm") + joint_xml("turn", "continuous", "base", "arm",
                                            R"(<origin xyz="0.3 -0.1 1.2"/><axis xyz="0 0 1"/>)")));
  const Vector3d pivot(0.3, -0.1, 1.2), at(0.05, 0.2, 1.1);
  const auto turned = [](double angle) { return Isometry3d(AngleAxisd(angle, Vector3d::UnitZ())); };
  const Isometry3d start = Translation3d(at) * turned(0.4);
  const double before = 0.7, after = before + 1.9;
  const Isometry3d end =
      Translation3d(pivot) * turned(after - before) * Translation3d(-pivot) * start;
  const Isometry3d in_arm = turned(-before) * Translation3d(-pivot) * start;  // T_arm_root * start
  const Image<float> depth = scene_depth(slab_camera(), 0.9);
  const auto mesh = std::make_shared<const PreparedMesh>(make_box(part_size));
  const TargetShape shapes[] = {
      BoxTarget{.pose = start, .size = part_size, .frame = ReferenceFrame::root()},
      BoxTarget{.pose = start, .size = part_size},  // the camera is at the root
      MeshTarget{.mesh = mesh, .pose = in_arm, .frame = ReferenceFrame::of_link("arm")}};
  for (const TargetShape& shape : shapes)
    for (const bool is_handled : {false, true}) {
      // What is not seen is not handled: the past_limit lets the empty scene pass.
      Target target = cup(at);
      target.shape = shape;
      target.thresholds.past_limit = 1.0;
      if (is_handled) target.handling = PoseTrackerConfig{};
      Pipeline pipeline(robot, slab_camera(), plain_config());
      std::vector<AttachedBody> attached;
      const auto pose_at = [&](std::int64_t stamp, double angle) {
        std::vector<double> positions(2);
        positions[robot.find_variable("slide").value()] = 0.9;
        positions[robot.find_variable("turn").value()] = angle;
        const FrameReport& report =
            pipeline.process({.stamp = stamp,
                              .depth = depth.view(),
                              .pose = {.positions = positions, .attached = attached},
                              .targets = {target}});
        EXPECT_EQ(report.targets[0].verdict, attached.empty() ? Verdict::visible : Verdict::held);
        const auto& handled = report.targets[0].handled;
        if (!handled) return Isometry3d::Identity();
        return Isometry3d(Translation3d(*handled->position) * *handled->orientation);
      };
      pose_at(1 * ms, before);
      attached = {pipeline.attach_target(target, "arm")};
      EXPECT_TRUE(attached[0].T_link_body.isApprox(in_arm, exact));
      const Isometry3d found = pose_at(2 * ms, after);
      EXPECT_TRUE(!is_handled || found.isApprox(end, exact));
      // From link to link it keeps the pose that it has, not the one that is given.
      const AttachedBody again = pipeline.attach_target(target, "base");
      EXPECT_TRUE(again.T_link_body.isApprox(end, exact));
    }
}

TEST_F(Carrying, WhatIsNotKnownIsNotAttached) {
  const auto refuses = [&](const Target& target, const char* why, const char* link = "slab") {
    expect_refused([&] { (void)pipeline_.attach_target(target, link); }, {"'cup'", why});
  };
  const Target target = cup(picked);
  refuses(target, "last frame");
  see(target, 1.0, picked);
  refuses(target, "'no_link'", "no_link");
  EXPECT_NO_THROW((void)pipeline_.attach_target(target, "slab"));
  const std::pair<const char*, std::function<void(Target&)>> faults[] = {
      {"3-D shape",
       [](Target& t) {
         t.shape = RegionTarget{.region = PixelBox{1, 1, 5, 5}};
       }},
      {"stamp", [&](Target& t) { t.stamp = stamp_ - period; }},
      {"not found", [](Target& t) { t.estimate = TargetEstimate{.value = std::monostate()}; }},
      {"its driver failed", [](Target& t) { t.fault = "its driver failed"; }}};
  for (const auto& [why, spoil] : faults) {
    Target faulty = target;
    spoil(faulty);
    refuses(faulty, why);
  }
  Target handled = cup(picked, PoseTrackerConfig{});
  pipeline_.forget_targets();
  handled.estimate = TargetEstimate{.value = std::monostate()};
  see(handled, 1.0, picked);
  refuses(handled, "lost");
  pipeline_.process({.targets = {target}});
  refuses(target, "pose");
}

/// A target's verdict and what hides it are those of its stamp.
TEST(HeldTargets, LateOnesAreHeldIfTheyWereAtTheirStamp) {
  PipelineConfig config = plain_config();
  config.target_history = 1.0;
  Pipeline pipeline(slab_robot(), slab_camera(), config);
  const Image<float> with = scene_depth(slab_camera(), 0.0, {part_box()});
  const Image<float> without = scene_depth(slab_camera(), 0.0);
  const auto expect = [&](std::int64_t stamp, bool is_carried, std::int64_t asked, Verdict of_cup,
                          Verdict behind_it) {
    Frame frame = frame_of(is_carried ? with : without, 0.0,
                           {region("cup", PixelBox{5, 5, 6, 6}), region("behind", behind_part)});
    if (is_carried) frame.pose.attached = {part("cup")};
    frame.stamp = stamp * ms;
    for (Target& target : frame.targets) target.stamp = asked * ms;
    expect_verdicts(pipeline.process(frame), {of_cup, behind_it});
  };
  using enum Verdict;
  expect(1, false, 1, visible, visible);
  expect(2, true, 1, visible, visible);
  expect(3, true, 2, held, hidden);
  expect(4, false, 3, held, hidden);
  expect(5, false, 4, visible, visible);
}

/// Without a depth image the carrier's pose is known; without joints nothing is.
TEST(HeldTargets, NeedThePoseOnly) {
  Pipeline pipeline(slab_robot(), slab_camera(), plain_config());
  Frame frame{.pose = {.attached = {part("cup")}}, .targets = {cup(picked)}};
  const TargetReport& without_pose = pipeline.process(frame).targets[0];
  EXPECT_EQ(without_pose.verdict, Verdict::unknown);
  EXPECT_TRUE(holds(without_pose.reason, to_string(FrameStatus::missing_joints)));
  frame.pose.positions = {0.0};
  EXPECT_EQ(pipeline.process(frame).targets[0].verdict, Verdict::held);
}

}  // namespace
}  // namespace penumbra::test
