// SPDX-License-Identifier: Apache-2.0
// Targets on labels that are made on the gl backend's device, beside the same targets where virtual
// depth comes back and the CPU labels.
#include "opengl.hpp"
#include "random.hpp"
#include "targets_fixture.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr std::int64_t period = 33 * ms;

PipelineConfig device_config(bool labels_on_device) {
  PipelineConfig config = plain_config(Backend::gl);
  config.rule.front_min_width = 5;
  config.rule.edge_margin = 4;
  config.target_history = 0.5;
  config.labels_on_device = labels_on_device;
  return config;
}

class GlTargets : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_opengl()) GTEST_SKIP() << no_opengl;
  }

  /// The slab swings; something stands before all of it, there are holes.
  void frame(int index) {
    slide_ = {0.3 * std::sin(0.4 * index)};
    depth_ = scene_depth(slab_camera(), slide_[0]);
    for (int v = 70; v < 90; ++v)
      for (int u = 20; u < 70; ++u) depth_(u, v) = index % 3 == 0 ? 0.0F : 0.5F;
    stamp_ = index * period;
  }
  const FrameReport& process(Pipeline& pipeline, std::span<const Target> targets) const {
    return pipeline.process(
        {.stamp = stamp_, .depth = depth_.view(), .joints = slide_, .targets = targets});
  }

  std::vector<double> slide_;
  Image<float> depth_;
  std::int64_t stamp_ = 0;
};

TEST_F(GlTargets, AreJudgedAsOnLabelsOfTheCpu) {
  std::mt19937_64 random = seeded_random(51);
  std::uniform_real_distribution<double> u(-10, 160), v(-10, 120), size(2, 50);
  Pipeline device(slab_robot(), slab_camera(), device_config(true));
  Pipeline host(slab_robot(), slab_camera(), device_config(false));
  int verdicts[5] = {}, points = 0, host_points = 0;
  for (int i = 0; i < 40; ++i) {
    frame(i);
    std::vector<std::string> names(30);
    for (std::size_t k = 0; k < names.size(); ++k) names[k] = "target " + std::to_string(k);
    std::vector<Target> targets;
    for (int k = 0; k < 30; ++k) {
      Target target{.name = names[static_cast<std::size_t>(k)]};
      const double left = u(random), top = v(random);
      if (k % 3 == 0) {
        target.shape = KeypointTarget{.pixel = {left, top}};
      } else {
        const double width = size(random), height = size(random);
        const bool is_modal = k % 3 == 1;
        if (is_modal)  // the same one in each frame, to compare with the last
          target.shape = RegionTarget{PixelBox{5.0 * k, 3.0 * k, 30, 20}, Extent::modal};
        else
          target.shape = RegionTarget{PixelBox{left, top, width, height}};
        if (k % 2 == 0 && i > 3) target.stamp = stamp_ - 2 * period;  // of a frame that was kept
      }
      targets.push_back(target);
    }
    const FrameReport& expected = process(host, targets);
    const FrameReport& report = process(device, targets);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      const TargetReport& of_host = expected.targets[k];
      const TargetReport& of_device = report.targets[k];
      SCOPED_TRACE("frame " + std::to_string(i) + ", " + names[k]);
      EXPECT_EQ(of_device.verdict, of_host.verdict);
      EXPECT_EQ(of_device.reason, of_host.reason);
      ASSERT_EQ(of_device.judgement.has_value(), of_host.judgement.has_value());
      if (!of_host.judgement) continue;
      EXPECT_EQ(of_device.judgement->occluded, of_host.judgement->occluded);
      EXPECT_EQ(of_device.judgement->front, of_host.judgement->front);
      EXPECT_EQ(of_device.judgement->clear, of_host.judgement->clear);
      EXPECT_EQ(of_device.judgement->measured, of_host.judgement->measured);
      EXPECT_TRUE(of_device.judgement->blame.empty()) << "links stay on the device";
      // Fewer depths are trusted than where the robot's own is known.
      EXPECT_LE(of_device.judgement->point_pixels, of_host.judgement->point_pixels);
      if (of_device.point) {
        EXPECT_TRUE(of_host.point);
      }
      verdicts[static_cast<std::size_t>(of_host.verdict)] += 1;
      points += of_device.point ? 1 : 0;
      host_points += of_host.point ? 1 : 0;
    }
  }
  for (const Verdict verdict : {Verdict::visible, Verdict::partial, Verdict::hidden})
    EXPECT_GT(verdicts[static_cast<std::size_t>(verdict)], 20);
  EXPECT_GT(points, host_points / 4);
}

/// The wall is at 3 m everywhere, and the slab's depths are blurred into its surroundings.
TEST_F(GlTargets, HaveNoPointsOfDepthsBesideTheRobot) {
  Pipeline device(slab_robot(), slab_camera(), device_config(true));
  frame(0);
  const std::vector<Target> targets{region("far", PixelBox{2, 5, 20, 20}),
                                    region("beside", PixelBox{100, 50, 2, 10})};
  const FrameReport& report = process(device, targets);
  ASSERT_TRUE(report.targets[0].point);
  EXPECT_NEAR(report.targets[0].point->z(), wall_depth, 1e-6);
  EXPECT_EQ(report.targets[1].verdict, Verdict::visible);
  EXPECT_FALSE(report.targets[1].point);
}

TEST_F(GlTargets, OfKnownDepthAreUnknown) {
  Pipeline device(slab_robot(), slab_camera(), device_config(true));
  frame(0);
  Target point{.name = "point", .shape = PointTarget{.position = {0, 0, 2}}};
  Target box{.name = "box", .shape = BoxTarget{.size = {0.1, 0.1, 0.1}}};
  std::get<BoxTarget>(box.shape).pose.translation() = Eigen::Vector3d(0, 0, 2);
  const Target expected{.name = "expected",
                        .shape = RegionTarget{PixelBox{10, 10, 5, 5}, Extent::amodal, 2.0}};
  Target behind{.name = "behind", .shape = PointTarget{.position = {0, 0, -2}}};
  const std::vector<Target> targets{point, box, expected, behind};
  const FrameReport& report = process(device, targets);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(report.targets[i].verdict, Verdict::unknown) << report.targets[i].name;
    EXPECT_NE(report.targets[i].reason.find("stays on the device"), std::string_view::npos)
        << report.targets[i].reason;
  }
  EXPECT_EQ(report.targets[3].verdict, Verdict::out_of_view);
}

/// A key point behind the slab holds the point that was measured before.
TEST_F(GlTargets, HoldPoints) {
  Pipeline device(slab_robot(), slab_camera(), device_config(true));
  const auto at = [&](double u, int index) {
    frame(0);
    stamp_ = index * period;
    const Target target{.name = "hand",
                        .shape = KeypointTarget{.pixel = {u, 57}},
                        .handling = PointTrackerConfig{}};
    return process(device, {&target, 1}).targets[0];
  };
  for (int i = 0; i < 5; ++i) {
    const TargetReport report = at(20 + i, i);
    ASSERT_TRUE(report.handled);
    EXPECT_EQ(report.handled->source, Source::measured);
  }
  const TargetReport hidden = at(70, 5);
  EXPECT_EQ(hidden.verdict, Verdict::hidden);
  ASSERT_TRUE(hidden.handled && hidden.handled->position);
  EXPECT_NE(hidden.handled->source, Source::measured);
  EXPECT_NEAR(hidden.handled->position->z(), wall_depth, 0.05);
}

/// Without the sensor's image what is not behind the robot is unknown, here too.
TEST_F(GlTargets, SeeNothingInBlindFrames) {
  Pipeline device(slab_robot(), slab_camera(), device_config(true));
  frame(0);
  const Target target = region("wall", PixelBox{2, 5, 20, 20});
  const FrameReport& report =
      device.process({.stamp = 0, .depth = {}, .joints = slide_, .targets = {&target, 1}});
  EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
  EXPECT_NE(report.targets[0].reason.find("depth"), std::string_view::npos);
}

}  // namespace
}  // namespace penumbra::test
