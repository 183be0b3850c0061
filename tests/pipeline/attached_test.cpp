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

}  // namespace
}  // namespace penumbra::test
