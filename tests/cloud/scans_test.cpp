// SPDX-License-Identifier: Apache-2.0
// Scans of robots that move, or whose pose is not wholly known, against closed forms.
#include "../robot/urdf_text.hpp"
#include "shapes.hpp"

#include <penumbra/mesh/primitives.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/poses/robot_pose.hpp>

namespace penumbra::test {
namespace {

constexpr double bar_tolerance = 0.02;  // metres
constexpr double turning_speed = 2.0;   // rad/s
constexpr std::int64_t scan_begin = 5'000 * ms;

/// A bar, 1 m long and 0.1 m wide and high, that turns in the plane around the middle of its end,
/// and a block above it that slides up.
Robot bar_robot(const std::string& block = R"(<box size="0.2 0.2 0.2"/>)") {
  return parse(
      robot_xml(link_xml("base") +
                link_xml("bar", collision_xml(R"(<box size="1 0.1 0.1"/>)",
                                              R"(<origin xyz="0.5 0 0"/>)")) +
                joint_xml("turn", "continuous", "base", "bar", R"(<axis xyz="0 0 1"/>)") +
                link_xml("block", collision_xml(block)) +
                joint_xml("slide", "prismatic", "base", "block",
                          R"(<origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit upper="0.5"/>)")),
      {.allow_missing_meshes = true});
}

/// A sensor that stands 2 m from the base and looks at it.
CloudConfig config() {
  return {.rule = {.tolerance = {bar_tolerance, 0, 0}, .beam = 0.0},
          .T_parent_sensor = at(0, -2, 0)};
}

double angle_at(std::int64_t stamp) {
  return 1.0 + turning_speed * 1e-9 * double(stamp - scan_begin);
}

/// The bar turns at turning_speed, up to a last stamp.
PoseAt turning(std::int64_t last = std::numeric_limits<std::int64_t>::max()) {
  return [last](std::int64_t stamp, RobotPose& pose) {
    pose = {};
    if (stamp > last)
      pose = {.status = FrameStatus::stale_joints, .message = "joint 'turn' is stale"};
    else
      pose.positions = {angle_at(stamp), 0.0};
  };
}

struct Cloud {
  void add(const Vector3d& point, std::int64_t time) {
    for (int i = 0; i < 3; ++i) values.push_back(float(point[i]));
    times.push_back(std::int32_t(time));
  }
  [[nodiscard]] Frame scan(PoseAt pose_at) const {
    return {
        .stamp = scan_begin,
        .scan = Scan{.points = {reinterpret_cast<const std::byte*>(values.data()), times.size()},
                     .times = times},
        .pose_at = std::move(pose_at)};
  }

  std::vector<float> values;
  std::vector<std::int32_t> times;
};

/// Where the ray from the sensor in a direction meets the bar at a stamp, in the sensor's frame.
std::optional<Vector3d> bar_hit(const Vector3d& direction, std::int64_t stamp) {
  const Isometry3d T_bar_sensor =
      AngleAxisd(-angle_at(stamp), Vector3d::UnitZ()) * Translation3d(0, -2, 0);
  const Vector3d origin = T_bar_sensor.translation() - Vector3d(0.5, 0, 0);
  const Vector3d along = T_bar_sensor.linear() * direction;
  const auto enters = enter_box(origin, along, {0.5, 0.05, 0.05});
  if (!enters || *enters == 0.0) return std::nullopt;
  return *enters * direction;
}

/// A scan of 100 ms from the left to the right, in which the bar turns by 0.2 rad; behind it is a
/// wall. Returns how many points are of the bar.
std::size_t make_sweep(Cloud& cloud) {
  constexpr int columns = 2'000, rows = 20;
  std::size_t of_bar = 0;
  for (int column = 0; column < columns; ++column) {
    const std::int64_t time = 100 * ms * column / columns;
    for (int row = 0; row < rows; ++row) {
      const Vector3d direction =
          Vector3d(0.5 - 1.0 * column / columns, 1.0, 0.06 * row / rows - 0.03).normalized();
      const auto hit = bar_hit(direction, scan_begin + time);
      of_bar += hit ? 1 : 0;
      cloud.add(hit ? *hit : Vector3d(direction * 4.0), time);
    }
  }
  return of_bar;
}

std::vector<Label> labels_of(const FrameReport& report) {
  std::vector<Label> labels;
  for (int i = 0; i < report.labels.width; ++i)
    labels.push_back(static_cast<Label>(report.labels(i, 0)));
  return labels;
}

std::size_t count(const FrameReport& report, Label label) {
  const auto all = labels_of(report);
  return std::size_t(std::ranges::count(all, label));
}

TEST(Scans, FollowsTheRobotDuringAScan) {
  Cloud cloud;
  const std::size_t of_bar = make_sweep(cloud);
  ASSERT_GT(of_bar, 3'000U);
  Pipeline pipeline(bar_robot(), config());
  const FrameReport& report = pipeline.process(cloud.scan(turning()));
  EXPECT_EQ(report.status, FrameStatus::ok) << report.message;
  // The bar's end moves by 0.2 m.
  EXPECT_GE(report.parts, 20U);
  // Within a part the bar's outline moves by half a centimetre.
  constexpr double at_outlines = 0.02;
  const double found = double(count(report, Label::occluded) + count(report, Label::beyond));
  EXPECT_NEAR(found, double(of_bar), at_outlines * double(of_bar));
  EXPECT_LT(double(count(report, Label::beyond)), at_outlines * found);
  EXPECT_LT(double(count(report, Label::front)), at_outlines * found);

  // As if all were measured at once.
  Frame at_once = cloud.scan(turning());
  at_once.scan->times = {};
  const FrameReport& wrong = pipeline.process(at_once);
  EXPECT_EQ(wrong.parts, 1U);
  EXPECT_LT(double(count(wrong, Label::occluded)), 0.7 * double(of_bar));
}

TEST(Scans, SeesAMotionThatTurnsBack) {
  Cloud cloud;
  make_sweep(cloud);
  Pipeline pipeline(bar_robot(), config());
  const FrameReport& report = pipeline.process(cloud.scan([](std::int64_t stamp, RobotPose& pose) {
    const double time = 1e-9 * double(stamp - scan_begin);
    pose = {};
    pose.positions = {turning_speed * std::abs(time - 0.05), 0.0};
  }));
  EXPECT_GE(report.parts, 20U) << "although it ends where it began";
}

TEST(Scans, ThreadsChangeNothing) {
  Cloud cloud;
  make_sweep(cloud);
  CloudConfig several = config();
  several.threads = 3;
  several.rule.beam = 0.003;
  CloudConfig one = several;
  one.threads = 1;
  Pipeline a(bar_robot(), one), b(bar_robot(), several);
  const FrameReport& of_one = a.process(cloud.scan(turning()));
  const FrameReport& of_three = b.process(cloud.scan(turning()));
  EXPECT_EQ(labels_of(of_one), labels_of(of_three));
  const std::size_t links = cloud.times.size() * sizeof(std::uint16_t);
  EXPECT_EQ(std::memcmp(of_one.virtual_depth.links.data, of_three.virtual_depth.links.data, links),
            0);
}

TEST(Scans, WithoutPosesOfTheWholeScanNoPointIsTrusted) {
  Cloud cloud;
  make_sweep(cloud);
  Pipeline pipeline(bar_robot(), config());
  const FrameReport& report = pipeline.process(cloud.scan(turning(scan_begin + 90 * ms)));
  EXPECT_EQ(report.status, FrameStatus::stale_joints);
  EXPECT_TRUE(holds(report.message, "joint 'turn' is stale"));
  EXPECT_EQ(count(report, Label::unknown), cloud.times.size());
}

/// Points on the bar, on the block, above it, and far from both; the bar points to the sensor's
/// right.
Cloud few_points() {
  Cloud cloud;
  cloud.add({0.5, 1.95, 0}, 0);
  cloud.add({0, 1.9, 1}, 0);
  cloud.add({0, 1.95, 1.5}, 0);
  cloud.add({1.2, 3, 2}, 0);
  return cloud;
}

PoseAt standing(RobotPose pose) {
  if (pose.positions.empty()) pose.positions = {0.0, 0.0};
  return [pose](std::int64_t, RobotPose& to) { to = pose; };
}

/// The block's joint has no states at all: the rest of the cloud is not lost.
TEST(Scans, AJointWithoutStatesTakesWhatItMovesAlone) {
  const Cloud cloud = few_points();
  Pipeline pipeline(bar_robot(), config());
  const Robot& robot = pipeline.robot();
  PoseHistory history(robot);
  const std::string turn[] = {"turn"};
  const double level[] = {0.0};
  for (const std::int64_t stamp : {scan_begin - ms, scan_begin + ms})
    history.add_joints(stamp, turn, level);
  PoseLookup lookup(robot, {});
  const FrameReport& report = pipeline.process(
      cloud.scan([&](std::int64_t stamp, RobotPose& pose) { lookup.at(history, stamp, pose); }));
  using enum Label;
  EXPECT_EQ(report.status, FrameStatus::missing_link);
  EXPECT_TRUE(holds(report.message, "'slide'")) << report.message;
  EXPECT_EQ(labels_of(report), (std::vector{occluded, unknown, unknown, clear}));
  EXPECT_EQ(report.links[report.virtual_depth.links(0, 0) - 1], "bar");
  EXPECT_EQ(report.virtual_depth.links(1, 0), 0);
}

TEST(Scans, ALinkWithoutItsMeshLeavesAllUnknown) {
  const Cloud cloud = few_points();
  Pipeline pipeline(bar_robot(R"(<mesh filename="file:///none.stl"/>)"), config());
  const FrameReport& report = pipeline.process(cloud.scan(standing({})));
  EXPECT_EQ(report.status, FrameStatus::missing_link);
  EXPECT_TRUE(holds(report.message, "no geometry of link 'block'"));
  EXPECT_EQ(labels_of(report), std::vector(4, Label::unknown));
}

TEST(Scans, WhatIsAttachedIsOfTheRobot) {
  const Cloud cloud = few_points();
  Pipeline pipeline(bar_robot(), config());
  const auto mesh = std::make_shared<PreparedMesh>(make_box({0.1, 0.1, 0.1}));
  const FrameReport& report = pipeline.process(
      cloud.scan(standing({.attached = {{"part", "block", mesh, at(0, 0, 0.5)}}})));
  using enum Label;
  EXPECT_EQ(labels_of(report), (std::vector{occluded, occluded, occluded, clear}));
  EXPECT_EQ(report.links[report.virtual_depth.links(2, 0) - 1], "part");
  EXPECT_EQ(labels_of(pipeline.process(cloud.scan(standing({}))))[2], clear) << "put down";
  const FrameReport& unread =
      pipeline.process(cloud.scan(standing({.attached = {{"part", "block", nullptr}}})));
  EXPECT_EQ(unread.status, FrameStatus::missing_link);
  EXPECT_EQ(labels_of(unread), std::vector(4, unknown));
}

TEST(Scans, SaysWhatIsWrongWithACloud) {
  Pipeline pipeline(bar_robot(), config());
  const auto fault = [&](const Frame& frame) {
    const FrameReport& report = pipeline.process(frame);
    EXPECT_EQ(count(report, Label::unknown), frame.scan->points.count);
    EXPECT_NE(report.status, FrameStatus::ok);
    return report.message;
  };
  const PoseAt pose = standing({});
  EXPECT_TRUE(holds(fault(Cloud().scan(pose)), "no points"));
  Cloud none;
  for (int i = 0; i < 5'000; ++i) none.add(Vector3d::Constant(nan), 0);
  EXPECT_TRUE(holds(fault(none.scan(pose)), "no point of the cloud is a measurement"));
  Cloud millimetres = few_points();
  for (float& value : millimetres.values) value *= 1000.0F;
  EXPECT_TRUE(holds(fault(millimetres.scan(pose)), "millimetres"));
  Cloud few = few_points();
  few.times.pop_back();
  Frame frame = few.scan(pose);
  frame.scan->points.count = 4;
  EXPECT_TRUE(holds(fault(frame), "3 times for 4 points"));
  frame = few.scan(pose);
  frame.scan->times = {};
  for (const double y : {2.0, 1.935}) {  // or too near
    frame.scan->origin = Vector3d(0.5, y, 0.0);
    EXPECT_TRUE(holds(fault(frame), "inside link 'bar'"));
  }
  frame.source_status = FrameStatus::bad_depth;
  frame.source_message = "the file cannot be read";
  EXPECT_EQ(fault(frame), "the file cannot be read");
  EXPECT_EQ(pipeline.process({.stamp = scan_begin, .pose_at = pose}).status,
            FrameStatus::missing_depth);
}

TEST(Scans, MergedCloudsHaveNoRays) {
  Cloud cloud = few_points();
  cloud.add({0.5, 2.2, 0}, 0);  // behind the bar
  Pipeline pipeline(bar_robot(), config());
  Frame frame = cloud.scan(standing({}));
  EXPECT_EQ(labels_of(pipeline.process(frame))[4], Label::beyond);
  frame.scan->origin.reset();
  EXPECT_EQ(
      labels_of(pipeline.process(frame)),
      (std::vector{Label::occluded, Label::occluded, Label::clear, Label::clear, Label::clear}));
}

/// The bar before a box before a wall; the bar points to the sensor's right.
struct BoxScene {
  Vector3d centre{0.5, 3.0, 0.0}, half{0.2, 0.1, 0.2};
  bool is_there = true;
  std::size_t on_box = 0, behind_bar = 0;  // rays

  /// The box, in the sensor's frame or the root's.
  [[nodiscard]] Target target(const ReferenceFrame& frame = {}) const {
    const Vector3d in_root = centre - Vector3d(0, 2, 0);
    return {
        .name = "box",
        .shape = BoxTarget{.pose = at(frame.kind == ReferenceFrame::Kind::root ? in_root : centre),
                           .size = 2.0 * half,
                           .frame = frame}};
  }

  [[nodiscard]] Cloud scan() {
    Cloud cloud;
    constexpr int steps = 200;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const Vector3d ray =
            Vector3d(0.4 * (i + 0.5) / steps, 1.0, 0.4 * (j + 0.5) / steps - 0.2).normalized();
        const auto bar = enter_box(Vector3d(-0.5, -2.0, 0.0), ray, {0.5, 0.05, 0.05});
        const auto box = enter_box(-centre, ray, half);
        on_box += box ? 1 : 0;
        behind_bar += box && bar ? 1 : 0;
        cloud.add(ray * (bar ? *bar : box && is_there ? *box : 4.0 / ray.y()), 0);
      }
    return cloud;
  }
};

TEST(Scans, JudgesBoxesAsTheRaysSeeThem) {
  Pipeline pipeline(bar_robot(), config());
  const auto judge = [&](BoxScene scene, const PoseAt& pose) {
    const Cloud cloud = scene.scan();
    Frame frame = cloud.scan(pose);
    frame.targets = {scene.target(), scene.target(ReferenceFrame::root())};
    for (Target& target : frame.targets) target.has_identity = false;
    const FrameReport& report = pipeline.process(frame);
    EXPECT_EQ(report.targets.size(), 2U);
    EXPECT_EQ(report.targets[0].verdict, report.targets[1].verdict);
    return report.targets[0];
  };
  BoxScene scene;
  (void)scene.scan();
  ASSERT_GT(scene.on_box, 3'000U);
  const double hidden = double(scene.behind_bar) / double(scene.on_box);
  const TargetReport partial = judge(BoxScene(), standing({}));
  EXPECT_EQ(partial.verdict, Verdict::partial);
  EXPECT_EQ(partial.judgement->inside, scene.on_box);
  EXPECT_DOUBLE_EQ(partial.judgement->occluded, hidden);
  EXPECT_EQ(partial.judgement->blame.front().name, "bar");
  EXPECT_DOUBLE_EQ(partial.judgement->blame.front().fraction, hidden);

  EXPECT_EQ(judge({.half = {0.1, 0.1, 0.03}}, standing({})).verdict, Verdict::hidden);
  const BoxScene aside{.centre = {0.5, 3.0, 0.35}};
  EXPECT_EQ(judge(aside, standing({})).verdict, Verdict::visible);
  BoxScene absent = aside;
  absent.is_there = false;
  const TargetReport past = judge(absent, standing({}));
  EXPECT_EQ(past.verdict, Verdict::unknown);
  EXPECT_TRUE(holds(past.reason, "looks past"));
  EXPECT_TRUE(holds(judge({.centre = {-5.0, 3.0, 0.0}}, standing({})).reason, "0 measured rays"));
  const TargetReport no_pose = judge(BoxScene(), turning(0));
  EXPECT_EQ(no_pose.verdict, Verdict::unknown);
  EXPECT_TRUE(holds(no_pose.reason, "joint 'turn' is stale"));
}

TEST(Scans, JudgesPointsAndNoPixels) {
  Pipeline pipeline(bar_robot(), config());
  BoxScene scene;
  const Cloud cloud = scene.scan();
  Frame frame = cloud.scan(standing({}));
  frame.targets = {
      {.name = "behind", .shape = PointTarget{.position = {0.5, 2.95, 0.0}, .radius = 0.05}},
      {.name = "on the box", .shape = PointTarget{.position = {0.5, 2.95, 0.15}, .radius = 0.05}},
      {.name = "pixels", .shape = KeypointTarget{.pixel = {5.0, 5.0}}}};
  const FrameReport& report = pipeline.process(frame);
  EXPECT_EQ(report.targets[0].verdict, Verdict::hidden);
  EXPECT_EQ(report.targets[1].verdict, Verdict::visible);
  EXPECT_TRUE(holds(report.targets[2].reason, "only 3-D boxes and points"));
  frame.scan->origin.reset();
  EXPECT_TRUE(holds(pipeline.process(frame).targets[0].reason, "without rays"));
}

TEST(Scans, FollowsAndForgetsTargetsAsInImages) {
  constexpr double fall = 0.05, accuracy = 0.02;  // metres: in 0.1 s, of the prediction
  Pipeline pipeline(bar_robot(), config());
  // A box comes down behind the bar.
  const auto at_step = [&](int step, std::size_t times = 1, int shift_ms = 0) {
    BoxScene scene{.centre = {0.5, 3.0, 0.35 - fall * step}, .half = {0.1, 0.1, 0.03}};
    const Cloud cloud = scene.scan();
    Frame frame = cloud.scan(standing({}));
    frame.targets = std::vector(times, scene.target(ReferenceFrame::root()));
    for (Target& target : frame.targets) target.handling = PoseTrackerConfig{};
    *frame.stamp += ms * (100 * step + shift_ms);
    return pipeline.process(frame).targets.back();
  };
  for (int step = 0; step < 5; ++step) {
    const TargetReport seen = at_step(step);
    EXPECT_EQ(seen.verdict, Verdict::visible);
    ASSERT_TRUE(seen.handled);
    EXPECT_EQ(seen.handled->source, Source::measured);
  }
  const TargetReport behind = at_step(7);
  EXPECT_EQ(behind.verdict, Verdict::hidden);
  EXPECT_EQ(behind.estimate, Outcome::refused_verdict);
  EXPECT_EQ(behind.handled->source, Source::predicted);
  EXPECT_LT((*behind.handled->position - Vector3d(0.5, 1.0, 0.0)).norm(), accuracy);
  EXPECT_EQ(at_step(3).verdict, Verdict::visible) << "a scan that comes late";
  EXPECT_TRUE(holds(at_step(8, 2).reason, "twice"));
  EXPECT_EQ(at_step(8).handled->source, Source::predicted);
  EXPECT_EQ(at_step(8, 1, -2'000).handled->source, Source::lost) << "the clock was set back";
}

TEST(Scans, JudgesTargetsThatComeLateOnTheScanOfTheirStamp) {
  CloudConfig config = test::config();
  config.target_history = 0.5;
  Pipeline pipeline(bar_robot(), config);
  const auto judge = [&](int step, std::optional<int> step_of_target) {
    BoxScene scene{.half = {0.1, 0.1, 0.03}};  // behind the bar, which then turns away
    const Cloud cloud = scene.scan();
    Frame frame = cloud.scan(standing({.positions = {step == 0 ? 0.0 : 2.0, 0.0}}));
    *frame.stamp += 100 * ms * step;
    if (step_of_target) {
      frame.targets = {scene.target()};
      frame.targets[0].stamp = scan_begin + 100 * ms * *step_of_target;
    }
    const FrameReport& report = pipeline.process(frame);
    return report.targets.empty() ? TargetReport() : report.targets[0];
  };
  judge(0, {});
  EXPECT_EQ(judge(1, 0).verdict, Verdict::hidden);
  EXPECT_EQ(judge(4, 0).verdict, Verdict::hidden);
  EXPECT_TRUE(holds(judge(6, 0).reason, "no scan of its stamp is stored"));
  EXPECT_TRUE(holds(judge(7, 9).reason, "no scan of its stamp is stored"));
}

TEST(Scans, BadConfigurationsAreRefused) {
  CloudConfig wrong = config();
  wrong.sensor_parent = "nobody";
  EXPECT_THROW(Pipeline(bar_robot(), wrong), InputError);
  wrong = config();
  wrong.T_parent_sensor.linear() *= 2.0;
  EXPECT_THROW(Pipeline(bar_robot(), wrong), InputError);
  wrong.rule.beam = 0.1;
  EXPECT_THROW(wrong.rule.check(), InputError);
  EXPECT_THROW((void)CloudRule::for_sensor("eyes"), InputError);
}

}  // namespace
}  // namespace penumbra::test
