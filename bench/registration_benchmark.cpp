// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of depth registration, 1280x720 to 1280x720: a tilted wall and a grid of nearer
// balls, with the noise and the holes of a sensor, between a depth and a colour camera as a
// RealSense has them, with lens distortion in neither, one or both.
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <penumbra/camera/registration.hpp>

namespace penumbra::bench {
namespace {

constexpr int width = 1280;
constexpr int height = 720;
constexpr std::uint64_t seed = 7;
constexpr unsigned holes = 50;       // one pixel of so many has no measurement
constexpr double noise = 0.002;      // metres at 1 m, growing with the square of the depth
constexpr double ball_radius = 0.1;  // metres

Camera camera(double focal, bool distorted) {
  const std::vector<double> lens{-0.0554, 0.0648, 0.00047, -0.00028, -0.0206};
  return {.intrinsics = Intrinsics(width, height, focal, focal, 638.2, 361.7),
          .distortion = distorted ? Distortion("plumb_bob", lens) : Distortion(),
          .range = {},
          .frame_id = {}};
}

double scene_depth(const Eigen::Vector3d& ray) {
  double depth = 2.0 / (1.0 + 0.3 * ray.x());  // the wall
  for (int i = -2; i <= 2; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const Eigen::Vector3d centre(0.35 * i, 0.35 * j, 1.0 + 0.05 * i);
      const double a = ray.squaredNorm();
      const double b = ray.dot(centre);
      const double root = b * b - a * (centre.squaredNorm() - ball_radius * ball_radius);
      if (root > 0) depth = std::min(depth, (b - std::sqrt(root)) / a);
    }
  }
  return depth;
}

template <typename T>
Image<T> depth_image(const Camera& camera) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0.0, noise);
  Image<T> image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double z = scene_depth(camera.intrinsics.ray(u, v));
      const double measured = random() % holes == 0 ? 0.0 : z + z * z * error(random);
      image(u, v) = static_cast<T>(std::is_same_v<T, float> ? measured : 1e3 * measured);
    }
  }
  return image;
}

template <typename T>
void warp(benchmark::State& state, bool from_distorted, bool to_distorted) {
  const Camera from = camera(645.0, from_distorted);
  const Camera to = camera(912.0, to_distorted);
  Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();
  T_to_from.translation() = Eigen::Vector3d(0.059, 0.0002, 0.0003);
  T_to_from.rotate(Eigen::AngleAxisd(0.004, Eigen::Vector3d(0.3, 0.8, 0.5).normalized()));
  const Image<T> depth = depth_image<T>(from);
  DepthRegistration registration(from, to);
  for (auto _ : state) benchmark::DoNotOptimize(registration.warp(depth.view(), T_to_from));
}

void make_ready(benchmark::State& state) {
  for (auto _ : state) {
    DepthRegistration registration(camera(645.0, true), camera(912.0, true));
    benchmark::DoNotOptimize(registration);
  }
}

const int registered = [] {
  const auto add = [](const std::string& name, auto function, bool from, bool to) {
    benchmark::RegisterBenchmark(name.c_str(), function, from, to)->Unit(benchmark::kMillisecond);
  };
  add("uint16", warp<std::uint16_t>, false, false);
  add("float", warp<float>, false, false);
  add("uint16, from a lens", warp<std::uint16_t>, true, false);
  add("uint16, to a lens", warp<std::uint16_t>, false, true);
  benchmark::RegisterBenchmark("made ready, both lenses", make_ready)
      ->Unit(benchmark::kMillisecond);
  return 0;
}();

}  // namespace
}  // namespace penumbra::bench

BENCHMARK_MAIN();
