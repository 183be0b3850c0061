// SPDX-License-Identifier: Apache-2.0
#include "gl_benchmark.hpp"
#include "scenes.hpp"
#include "timing.hpp"

#include <algorithm>
#include <cstdio>
#include <latch>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace penumbra::bench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using nlohmann::json;

/// The scene's path as cameras see it that stand evenly around the robot.
std::vector<std::vector<LinkPoses>> paths_around(const BenchScene& scene, std::size_t cameras) {
  Vector3d middle = Vector3d::Zero();
  for (const Isometry3d& link : scene.path.front()) middle += link.translation();
  middle /= static_cast<double>(scene.path.front().size());
  std::vector<std::vector<LinkPoses>> paths(cameras, scene.path);
  for (std::size_t i = 0; i < cameras; ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(cameras);
    const Isometry3d around = Eigen::Translation3d(middle) *
                              Eigen::AngleAxisd(angle, Vector3d::UnitY()) *
                              Eigen::Translation3d(-middle);
    for (LinkPoses& poses : paths[i]) {
      for (Isometry3d& pose : poses) pose = around * pose;
    }
  }
  return paths;
}

class Cameras {
 public:
  Cameras(Backend backend, const BenchScene& scene, std::size_t count,
          const RendererOptions& options)
      : paths_(paths_around(scene, count)) {
    const std::vector<Body> bodies = scene.bodies();
    for (std::size_t i = 0; i < count; ++i)
      renderers_.push_back(make_depth_renderer(backend, scene.intrinsics, bodies, options));
  }

  /// What a frame of one camera costs when `threads` share the cameras; every camera's frames go
  /// ahead as far as they may.
  [[nodiscard]] PassCost draw(std::size_t threads) {
    const std::size_t frames = paths_.size() * paths_.front().size();
    if (threads == 1) return cost_of_pass(frames, [this] { draw_share(0, 1); });
    std::latch start(static_cast<std::ptrdiff_t>(threads) + 1);
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < threads; ++i) {
      workers.emplace_back([this, i, threads, &start] {
        start.arrive_and_wait();
        draw_share(i, threads);
      });
    }
    return cost_of_pass(frames, [&] {
      start.arrive_and_wait();
      workers.clear();  // joins
    });
  }

 private:
  void draw_share(std::size_t first, std::size_t step) {
    for (std::size_t frame = 0; frame < paths_.front().size(); ++frame) {
      for (std::size_t i = first; i < renderers_.size(); i += step) {
        DepthRenderer& renderer = *renderers_[i];
        if (renderer.pending() == renderer.max_pending()) static_cast<void>(renderer.collect());
        renderer.submit(paths_[i][frame]);
      }
    }
    for (std::size_t i = first; i < renderers_.size(); i += step) {
      while (renderers_[i]->pending() > 0) static_cast<void>(renderers_[i]->collect());
    }
  }

  std::vector<std::vector<LinkPoses>> paths_;
  std::vector<std::unique_ptr<DepthRenderer>> renderers_;
};

json print_row(std::size_t cameras, const std::string& name, std::size_t threads,
               const PassCosts& costs) {
  const PassCost best = costs.least();
  const PassCost median = costs.median();
  std::printf("%8zu %-10s %8zu %10.0f %10.0f %9.3f\n", cameras, name.c_str(), threads,
              1e3 / best.wall_ms, 1e3 / median.wall_ms, best.process_ms);
  std::fflush(stdout);
  return {{"cameras", cameras},
          {"name", name},
          {"threads", threads},
          {"frames_per_s", 1e3 / best.wall_ms},
          {"median_frames_per_s", 1e3 / median.wall_ms},
          {"cpu_ms", best.process_ms}};
}

}  // namespace

json compare_cameras(const GlSettings& settings) {
  const BenchScene scene = xarm7_scene(settings.frames);
  const std::string isa = compared_isas().front();
  std::printf("\n%s: %8s %-10s %8s %10s %10s %9s\n", scene.name.c_str(), "cameras", "renderer",
              "threads", "frames/s", "median", "CPU ms");
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  json rows;
  for (const std::size_t count : {1U, 4U, 16U}) {
    Cameras cpu(Backend::cpu, scene, count, {.isa = isa});
    Cameras gl(Backend::gl, scene, count, settings.gl);
    std::vector<std::size_t> threads{1};
    if (std::min(count, cores) > 1) threads.push_back(std::min(count, cores));
    for (const std::size_t n : threads) {
      PassCosts cpu_costs, gl_costs;
      for (int round = 0; round < settings.rounds; ++round) {
        cpu_costs.add(cpu.draw(n));
        gl_costs.add(gl.draw(n));
      }
      rows.push_back(print_row(count, "cpu " + isa, n, cpu_costs));
      rows.push_back(print_row(count, "gl", n, gl_costs));
    }
  }
  return rows;
}

}  // namespace penumbra::bench
