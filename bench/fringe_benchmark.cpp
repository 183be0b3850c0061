// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of labels with and without fringe on the ten real frames of xarm7_realsense. The
// virtual depth is rendered before every image, untimed.
#include "scenes.hpp"
#include "timing.hpp"

#include <algorithm>
#include <memory>

#include <benchmark/benchmark.h>

#include <penumbra/base/simd_target.hpp>
#include <penumbra/labels/labels.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

namespace penumbra::bench {
namespace {

/// The recorded images and the robot's poses in them.
struct RealScene {
  BenchScene scene;
  std::vector<Image<std::uint16_t>> measured;
};

RealScene real_scene() {
  const io::Recording recording = io::Recording::open(data_folder() / "xarm7_realsense");
  auto robot = std::make_shared<const Robot>(recording.load_robot());
  const io::FrameReader reader(recording, *robot);
  const Eigen::Isometry3d T_camera_root = recording.camera.camera.T_parent_camera->inverse();
  RealScene real{{"xArm 7, recorded", recording.camera.camera.intrinsics, robot, {}}, {}};
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const Frame frame = reader.read(i, false);
    LinkPoses poses(robot->links().size());
    robot->forward_kinematics(frame.pose.positions, poses);
    for (Eigen::Isometry3d& pose : poses) pose = T_camera_root * pose;
    real.scene.path.push_back(poses);
    real.measured.push_back(
        io::copy_of(std::get<ImageView<const std::uint16_t>>(frame.depth.view)));
  }
  return real;
}

void classify(benchmark::State& state, const RealScene& real, int reach, const std::string& isa) {
  const BenchScene& scene = real.scene;
  const auto renderer = make_depth_renderer(Backend::cpu, scene.intrinsics, scene.bodies(), {});
  LabelRule rule;
  rule.fringe_reach = reach;
  Classifier classifier(scene.intrinsics.width(), scene.intrinsics.height(), rule, isa);
  FrameTimes times(scene.path.size());
  std::vector<std::size_t> fringe(scene.path.size());
  std::size_t frame = 0;
  for (auto _ : state) {
    const VirtualDepthView robot = renderer->render(scene.path[frame]);
    LabelView labels;
    const double ms =
        time_ms([&] { labels = classifier.classify(robot, real.measured[frame].view()); });
    state.SetIterationTime(1e-3 * ms);
    times.add(frame, ms);
    fringe[frame] = labels.pixels[static_cast<std::size_t>(Label::fringe)];
    frame = (frame + 1) % scene.path.size();
  }
  state.counters["fastest_us"] = 1e3 * times.typical();
  double sum = 0.0;
  for (const std::size_t pixels : fringe) sum += static_cast<double>(pixels);
  state.counters["fringe_pixels"] = sum / static_cast<double>(fringe.size());
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using namespace penumbra::bench;
  benchmark::Initialize(&argc, argv);
  const auto real = std::make_shared<const RealScene>(real_scene());
  for (const std::string& isa : penumbra::simd_target_names())
    for (const int reach : {0, penumbra::LabelRule{}.fringe_reach})
      benchmark::RegisterBenchmark(
          (isa + ", fringe_reach " + std::to_string(reach)).c_str(),
          [real, reach, isa](benchmark::State& state) { classify(state, *real, reach, isa); })
          ->UseManualTime()
          ->ComputeStatistics("min", least)
          ->Iterations(400)
          ->Unit(benchmark::kMicrosecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
