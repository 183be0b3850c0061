// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of whole frames, kinematics to report, one thread: a moving robot seen by a
// sensor with noise and holes, without targets, with ten, also where other programs have used the
// caches, with frames kept for late targets, and with an attached body; and of the points of
// images.
#include "scenes.hpp"
#include "timing.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <penumbra/mesh/primitives.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/without_robot.hpp>

namespace penumbra::bench {
namespace {

constexpr std::size_t frames = 30;
constexpr std::size_t passes = 20;  // over the frames
constexpr std::uint64_t seed = 7;
constexpr std::int64_t frame_time = 33'333'333;  // nanoseconds
constexpr double history = 0.5;                  // seconds, the default of targets.yaml

enum class Kind { none, regions, objects };

struct Case {
  std::string name;
  Kind targets;
  double history;
  bool carries_ball = false;  ///< of 5 cm, attached to the last link
  bool is_cold = false;       ///< all caches are swept before each frame
  bool has_memory = true;     ///< LabelRule::scene_memory
};

std::vector<Case> all_cases() {
  return {
      {"no targets", Kind::none, 0},
      {.name = "no targets, no memory", .targets = Kind::none, .history = 0, .has_memory = false},
      {"no targets, cold", Kind::none, 0, false, true},
      {.name = "no targets, no memory, cold",
       .targets = Kind::none,
       .history = 0,
       .is_cold = true,
       .has_memory = false},
      {"no targets, a ball attached", Kind::none, 0, true},
      {"ten targets", Kind::regions, 0},
      {"ten targets, cold", Kind::regions, 0, false, true},
      {"ten targets, two rendered", Kind::objects, 0},
      {"ten targets, two rendered, 0.5 s of frames kept", Kind::objects, history}};
}

/// Six key points, of which one is followed, and four boxes of 32 x 32 pixels, spread over the
/// image; with `objects` two of the boxes are solid ones, followed by their poses.
class TenTargets {
 public:
  TenTargets(const Intrinsics& k, Kind kind) {
    if (kind == Kind::none) return;
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector2d at(k.width() * (0.15 + 0.07 * i),
                               k.height() * (i % 2 == 0 ? 0.4 : 0.6));
      Target target{.name = names[static_cast<std::size_t>(i)]};
      if (i < 6)
        target.shape = KeypointTarget{.pixel = at};
      else if (kind == Kind::objects && i >= 8)
        target.shape = solid(k, at);
      else
        target.shape = RegionTarget{PixelBox{at.x() - 16, at.y() - 16, 32, 32}};
      if (i == 0) target.handling = PointTrackerConfig{};
      if (std::holds_alternative<BoxTarget>(target.shape)) target.handling = PoseTrackerConfig{};
      all.push_back(target);
    }
  }

  std::vector<Target> all;

 private:
  static constexpr std::array names{"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"};

  static BoxTarget solid(const Intrinsics& k, const Eigen::Vector2d& at) {
    constexpr double distance = 1.5, edge = 0.1;  // metres
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = distance * k.ray(at.x(), at.y());
    return {pose, Eigen::Vector3d::Constant(edge), {}};
  }
};

/// Memory that is larger than the caches.
class Sweep {
 public:
  void operator()() {
    for (std::size_t i = 0; i < memory_.size(); i += line) memory_[i] ^= 1;
    benchmark::DoNotOptimize(memory_.data());
  }

 private:
  static constexpr std::size_t line = 64;  // bytes
  std::vector<unsigned char> memory_ = std::vector<unsigned char>(std::size_t{128} << 20);
};

/// Undisturbed times of a stage, and of all.
struct StageCosts {
  FrameTimes all{frames}, render{frames}, classify{frames}, targets{frames};

  void add(std::size_t frame, double ms, const StageTimes& timing) {
    all.add(frame, ms);
    render.add(frame, timing.render.value_or(0));
    classify.add(frame, timing.classify.value_or(0));
    targets.add(frame, timing.targets.value_or(0));
  }
};

void process(benchmark::State& state, const BenchScene& scene,
             const std::vector<Image<std::uint16_t>>& depth, const Case& c) {
  PipelineConfig config;
  config.renderer.threads = 1;
  config.target_history = c.history;
  if (!c.has_memory) config.rule.scene_memory = 0.0;
  Camera camera{scene.intrinsics, {}, {}, {}};
  camera.T_parent_camera = scene.T_root_camera;
  Pipeline pipeline(scene.load_robot(), camera, config);
  const TenTargets targets(scene.intrinsics, c.targets);
  std::vector<AttachedBody> attached;
  if (c.carries_ball)
    attached.push_back({.name = "ball",
                        .link = pipeline.robot().links().back(),
                        .mesh = std::make_shared<PreparedMesh>(make_sphere(0.05))});
  StageCosts times;
  std::optional<Sweep> sweep;
  if (c.is_cold) sweep.emplace();
  std::int64_t i = 0;
  for (auto _ : state) {
    const auto frame = static_cast<std::size_t>(i) % frames;
    const Frame given{.stamp = i * frame_time,
                      .depth = depth[frame].view(),
                      .pose = {.positions = scene.joints[frame], .attached = attached},
                      .targets = targets.all};
    if (sweep) (*sweep)();
    const FrameReport* report = nullptr;
    const double ms = time_ms([&] { report = &pipeline.process(given); });
    if (report->status != FrameStatus::ok) return state.SkipWithError("bad frame");
    state.SetIterationTime(1e-3 * ms);
    times.add(frame, ms, report->timing);
    ++i;
  }
  if (c.carries_ball)
    state.counters["triangles"] = static_cast<double>(attached[0].mesh->triangles.size());
  state.counters["typical_us"] = 1e3 * times.all.typical();
  state.counters["render_us"] = 1e3 * times.render.typical();
  state.counters["classify_us"] = 1e3 * times.classify.typical();
  state.counters["targets_us"] = 1e3 * times.targets.typical();
}

void make_points(benchmark::State& state, const BenchScene& scene,
                 const std::vector<Image<std::uint16_t>>& depth, const PointsRule& rule) {
  CloudMaker maker({scene.intrinsics, {}, {}, {}}, rule);
  const DepthImage image = depth.front();
  PointCloud cloud;
  for (auto _ : state) maker.make(image, cloud);
  state.counters["points"] = static_cast<double>(cloud.points.size());
}

void add_points(const std::shared_ptr<const BenchScene>& scene,
                const std::shared_ptr<const std::vector<Image<std::uint16_t>>>& depth) {
  for (const auto& [name, rule] :
       {std::pair{"all points", PointsRule()},
        {"points of a stride of 2", {.stride = 2}},
        {"points of voxels of 1 cm", {.voxel = 0.01}},
        {"points of voxels of 1 cm, of a stride of 2", {.stride = 2, .voxel = 0.01}}})
    benchmark::RegisterBenchmark((scene->name + ", " + name).c_str(), [scene, depth, rule](
                                                                          benchmark::State& state) {
      make_points(state, *scene, *depth, rule);
    })->Unit(benchmark::kMicrosecond);
}

void add_all(BenchScene made) {
  const auto scene = std::make_shared<const BenchScene>(std::move(made));
  const auto renderer = make_depth_renderer(Backend::cpu, scene->intrinsics, scene->bodies(), {});
  const auto depth =
      std::make_shared<const std::vector<Image<std::uint16_t>>>(sensor_images(*renderer, *scene));
  for (const Case& c : all_cases())
    benchmark::RegisterBenchmark(
        (scene->name + ", " + c.name).c_str(),
        [scene, depth, c](benchmark::State& state) { process(state, *scene, *depth, c); })
        ->UseManualTime()
        ->Iterations(passes * frames)
        ->Unit(benchmark::kMicrosecond);
  add_points(scene, depth);
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using namespace penumbra::bench;
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("frames", std::to_string(frames));
  benchmark::AddCustomContext("seed", std::to_string(seed));
  add_all(ur5e_scene(penumbra::Geometry::collision, 640, 480, 615.0, frames, seed));
  add_all(ur5e_scene(penumbra::Geometry::collision, 1280, 720, 915.0, frames, seed));
  add_all(xarm7_scene(frames));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
