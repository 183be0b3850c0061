// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of labelling scans: a lidar of 64 beams, which looks 100 degrees wide, near a
// robot that moves in a room. Parts: of a scan, each labelled with poses of its own.
#include "scenes.hpp"

#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <penumbra/cloud/scan.hpp>
#include <penumbra/mesh/triangle_tree.hpp>

namespace penumbra::bench {
namespace {

constexpr std::size_t frames = 10;
constexpr std::uint64_t seed = 7;
constexpr int beams = 64;
constexpr double height = 0.785, width = 1.745;  // radians, of its view
constexpr double wall = 4.0;                     // metres
constexpr double noise = 0.01;                   // metres
/// Where the lidar stands in the camera's frame: nearer, so that the robot fills more of its view.
const Eigen::Vector3d origin(0.0, 0.0, 0.7);

/// The ranges of what a scan's rays meet.
class Scanner {
 public:
  explicit Scanner(const std::vector<Body>& bodies) {
    for (const Body& body : bodies) trees_.emplace_back(body.meshes.begin(), body.meshes.end());
  }

  /// Returns x, y, z of points.
  [[nodiscard]] std::vector<float> scan(const LinkPoses& poses, int count, double& on_robot) {
    std::vector<float> points;
    int robot = 0;
    for (int i = 0; i < count; ++i) {
      const int column = i / beams, columns = count / beams;
      const double azimuth = width * ((column + 0.5) / columns - 0.5);
      const double elevation = height * ((i % beams + 0.5) / beams - 0.5);
      const Eigen::Vector3d ray(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                                std::cos(azimuth) * std::cos(elevation));
      double range = wall / ray.cwiseAbs().maxCoeff();
      const double before = range;
      for (std::size_t body = 0; body < trees_.size(); ++body) {
        const Eigen::Isometry3d T_body_camera = poses[body].inverse();
        for (const TriangleTree& mesh : trees_[body])
          range = std::min(
              range, mesh.first_hit(T_body_camera * origin, T_body_camera.linear() * ray, range));
      }
      robot += range < before ? 1 : 0;
      const Eigen::Vector3d point = origin + (range + noise_(random_)) * ray;
      for (const double x : point) points.push_back(static_cast<float>(x));
    }
    on_robot += static_cast<double>(robot) / count / frames;
    return points;
  }

 private:
  std::vector<std::vector<TriangleTree>> trees_;
  std::mt19937_64 random_{seed};
  std::normal_distribution<double> noise_{0.0, noise};
};

void label(benchmark::State& state, const BenchScene& scene) {
  const std::vector<Body> bodies = scene.bodies();
  const auto count = static_cast<int>(state.range(0));
  Scanner scanner(bodies);
  std::vector<std::vector<float>> scans;
  double on_robot = 0.0;
  for (std::size_t i = 0; i < frames; ++i)
    scans.push_back(scanner.scan(scene.path[i], count, on_robot));
  CloudLabeller labeller(bodies, {}, static_cast<int>(state.range(1)));
  const auto parts = static_cast<std::size_t>(state.range(2));
  std::vector<std::uint16_t> part_of;
  for (std::size_t point = 0; point < static_cast<std::size_t>(count); ++point)
    part_of.push_back(static_cast<std::uint16_t>(point * parts / static_cast<std::size_t>(count)));
  std::vector<LinkPoses> poses(frames);
  for (std::size_t frame = 0; frame < frames; ++frame)
    for (std::size_t part = 0; part < parts; ++part)
      poses[frame].insert(poses[frame].end(), scene.path[frame].begin(), scene.path[frame].end());
  std::size_t i = 0;
  for (auto _ : state) {
    const auto* const data = reinterpret_cast<const std::byte*>(scans[i % frames].data());
    const CloudLabels& labels =
        labeller.label({data, static_cast<std::size_t>(count)}, origin, poses[i % frames], part_of);
    benchmark::DoNotOptimize(labels.labels.data());
    ++i;
  }
  state.counters["robot_%"] = 100 * on_robot;
  state.counters["per_point"] = benchmark::Counter(
      count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void add_all(BenchScene made) {
  const auto scene = std::make_shared<const BenchScene>(std::move(made));
  benchmark::RegisterBenchmark(scene->name.c_str(),
                               [scene](benchmark::State& state) { label(state, *scene); })
      ->ArgNames({"points", "threads", "parts"})
      ->Args({50'000, 1, 1})
      ->Args({200'000, 1, 1})
      ->Args({800'000, 1, 1})
      ->Args({200'000, 2, 1})
      ->Args({200'000, 1, 4})
      ->Args({200'000, 1, 16})
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using namespace penumbra::bench;
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("seed", std::to_string(seed));
  add_all(ur5e_scene(penumbra::Geometry::collision, 1280, 720, 915.0, frames, seed));
  add_all(ur5e_scene(penumbra::Geometry::visual, 1280, 720, 915.0, frames, seed));
  add_all(xarm7_scene(frames));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
