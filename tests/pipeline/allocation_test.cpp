// SPDX-License-Identifier: Apache-2.0
#include "../support/allocations.hpp"
#include "slab_scene.hpp"

namespace penumbra::test {
namespace {

/// Frames in which memory grows: both kinds of depth, in every frame that is kept, and as many
/// estimates as are remembered.
constexpr int warm_up = 40;

/// A target's report has names and a reason of its own.
constexpr std::size_t strings_of_a_target = 4;

void expect_only_strings(bool distorted, ImageSpace image, double history) {
  Camera camera = slab_camera();
  const double coefficients[] = {-0.2, 0.05, 0.001, -0.001, 0.0};
  if (distorted) camera.distortion = Distortion("plumb_bob", coefficients);
  PipelineConfig config;
  config.image = image;
  config.target_history = history;
  Pipeline pipeline(slab_robot(), camera, config);
  const Image<float> metres = scene_depth(camera, 0.0);
  const Image<std::uint16_t> millimetres = to_millimetres(metres);
  Isometry3d pose = Isometry3d::Identity();
  pose.translation().z() = 0.7;
  Frame frame{.pose = {.positions = {0.0}}};
  frame.targets = {{.name = "region of pixels", .shape = RegionTarget{PixelBox{10, 80, 20, 12}}},
                   {.name = "key point that is handled",
                    .shape = KeypointTarget{.pixel = {20, 85}},
                    .handling = PointTrackerConfig{.max_estimates = 8}},
                   {.name = "box that is handled",
                    .shape = BoxTarget{pose, {0.05, 0.05, 0.05}, {}},
                    .handling = PoseTrackerConfig{.max_estimates = 8}},
                   {.name = "late", .shape = RegionTarget{PixelBox{30, 40, 60, 30}}}};
  for (int i = 0; i < 120; ++i) {
    if (i == 80) frame.targets.clear();
    if (history > 0 && i < 80) frame.targets.back().stamp = (i - 5) * 10'000'000;
    frame.stamp = i * 10'000'000;
    frame.pose.positions[0] = 0.01 * i;
    if (i < 80) std::get<BoxTarget>(frame.targets[2].shape).size.x() = 0.05 + 0.001 * i;  // jitters
    frame.depth = i % 2 == 0 ? DepthView(metres.view()) : DepthView(millimetres.view());
    const std::size_t before = allocations();
    const FrameReport& report = pipeline.process(frame);
    const std::size_t after = allocations();
    ASSERT_EQ(report.status, FrameStatus::ok);
    if (i < warm_up) continue;
    ASSERT_LE(after - before, strings_of_a_target * frame.targets.size()) << "frame " << i;
  }
}

TEST(Allocation, IsOfStringsOfTargetsAlone) {
  for (const double history : {0.0, 0.1})
    for (const bool distorted : {false, true})
      expect_only_strings(distorted, ImageSpace::raw, history);
  expect_only_strings(true, ImageSpace::rectified, 0.0);
}

}  // namespace
}  // namespace penumbra::test
