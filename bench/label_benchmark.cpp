// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of the classifier, for work on its kernels: a moving robot seen by a sensor with
// noise and holes, labelled alone, with the clean-up, and with all of the robot behind something
// near and holed, which is the most that the clean-up can meet. The virtual depth is rendered
// before every image, untimed, so that caches hold what they hold in use.
#include "scenes.hpp"
#include "timing.hpp"

#include <algorithm>
#include <memory>
#include <random>

#include <benchmark/benchmark.h>

#include <penumbra/base/simd_target.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra::bench {
namespace {

constexpr std::size_t frames = 30;
constexpr std::uint64_t seed = 7;

struct SensorModel {
  float wall = 2500.0F;  // millimetres, behind the robot
  float noise = 4.0F;    // millimetres, standard deviation
  float before = 0.0F;   // millimetres; not 0: all that the sensor sees is there
  unsigned holes = 100;  // one pixel of so many has no measurement
};

struct Case {
  std::string name;
  LabelRule rule;
  SensorModel sensor;
};

std::vector<Case> all_cases() {
  LabelRule without_cleanup;
  without_cleanup.front_min_width = 0;
  return {{"labels alone", without_cleanup, {}},
          {"with clean-up", LabelRule{}, {}},
          {"all front", LabelRule{}, {.before = 300.0F, .holes = 50}}};
}

Image<std::uint16_t> sensor_image(ImageView<const float> robot, const SensorModel& model,
                                  std::mt19937& random) {
  std::normal_distribution<float> noise(0.0F, model.noise);
  Image<std::uint16_t> image(robot.width, robot.height);
  for (int v = 0; v < robot.height; ++v) {
    for (int u = 0; u < robot.width; ++u) {
      const float seen = robot(u, v) > 0 ? 1e3F * robot(u, v) : model.wall;
      const float d = (model.before > 0 ? model.before : seen) + noise(random);
      const bool hole = random() % model.holes == 0;
      image(u, v) = hole ? std::uint16_t{0} : static_cast<std::uint16_t>(std::max(1.0F, d));
    }
  }
  return image;
}

void classify(benchmark::State& state, const BenchScene& scene, const Case& c,
              const std::string& isa) {
  const auto renderer = make_depth_renderer(Backend::cpu, scene.intrinsics, scene.bodies(), {});
  Classifier classifier(scene.intrinsics.width(), scene.intrinsics.height(), c.rule, isa);
  std::mt19937 random(seed);
  std::vector<Image<std::uint16_t>> sensor;
  for (const LinkPoses& poses : scene.path)
    sensor.push_back(sensor_image(renderer->render(poses).depth, c.sensor, random));
  LabelView labels;
  FrameTimes times(scene.path.size());
  std::size_t frame = 0;
  for (auto _ : state) {
    const VirtualDepthView robot = renderer->render(scene.path[frame]);
    const double ms = time_ms([&] { labels = classifier.classify(robot, sensor[frame].view()); });
    state.SetIterationTime(1e-3 * ms);
    times.add(frame, ms);
    frame = (frame + 1) % scene.path.size();
  }
  // Where each frame had its turn: what a frame costs undisturbed.
  if (static_cast<std::size_t>(state.iterations()) >= frames)
    state.counters["typical_us"] = 1e3 * times.typical();
  const auto pixels = static_cast<double>(labels.labels.width) * labels.labels.height;
  const auto clear = static_cast<double>(labels.pixels[static_cast<std::size_t>(Label::clear)]);
  state.counters["robot_pixels"] = pixels - clear;
  state.counters["front"] =
      static_cast<double>(labels.pixels[static_cast<std::size_t>(Label::front)]);
}

void add_all(BenchScene made) {
  const auto scene = std::make_shared<const BenchScene>(std::move(made));
  for (const Case& c : all_cases()) {
    for (const std::string& isa : simd_target_names()) {
      benchmark::RegisterBenchmark(
          (scene->name + ", " + c.name + ", " + isa).c_str(),
          [scene, c, isa](benchmark::State& state) { classify(state, *scene, c, isa); })
          ->UseManualTime()
          ->Unit(benchmark::kMicrosecond);
    }
  }
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using namespace penumbra::bench;
  using penumbra::Geometry;
  benchmark::Initialize(&argc, argv);
  const penumbra::LabelRule rule;
  benchmark::AddCustomContext("front_min_width", std::to_string(rule.front_min_width));
  benchmark::AddCustomContext("edge_margin", std::to_string(rule.edge_margin));
  benchmark::AddCustomContext("frames", std::to_string(frames));
  benchmark::AddCustomContext("seed", std::to_string(seed));
  add_all(ur5e_scene(Geometry::collision, 640, 480, 615.0, frames, seed));
  add_all(ur5e_scene(Geometry::collision, 1280, 720, 915.0, frames, seed));
  add_all(ur5e_scene(Geometry::collision, 1920, 1080, 1372.0, frames, seed));
  add_all(xarm7_scene(frames));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
