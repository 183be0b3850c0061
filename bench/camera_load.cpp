// SPDX-License-Identifier: Apache-2.0
// Judges the frames of many cameras as they arrive and counts those that are dropped:
// camera_load [--cameras N] [--threads N] [--seconds S]. A UR5e with ten targets before cameras of
// 640x480 at 30 Hz. Each camera has a pipeline of its own; threads take the frame that has waited
// longest. A frame that waits when the camera's next one arrives is dropped.
#include "scenes.hpp"
#include "timing.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t frames = 60;
constexpr std::uint64_t seed = 7;
constexpr double rate = 30.0;  // Hz
constexpr auto usage = "expected [--cameras N] [--threads N] [--seconds S]";

struct Load {
  std::size_t cameras = 100;
  std::size_t threads = 1;
  double seconds = 60.0;

  Load(int argc, char** argv) {
    for (int i = 1; i + 1 < argc; i += 2) {
      const std::string name = argv[i];
      const double value = std::stod(argv[i + 1]);
      if (name == "--cameras" && value >= 1)
        cameras = static_cast<std::size_t>(value);
      else if (name == "--threads" && value >= 1)
        threads = static_cast<std::size_t>(value);
      else if (name == "--seconds" && value > 0)
        seconds = value;
      else
        throw std::runtime_error(usage);
    }
    if (argc % 2 == 0) throw std::runtime_error(usage);
  }
};

std::vector<Target> ten_targets(const Intrinsics& k) {
  std::vector<Target> targets;
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector2d at(k.width() * (0.15 + 0.07 * i), k.height() * (i % 2 == 0 ? 0.4 : 0.6));
    Target target{.name = std::to_string(i)};
    if (i < 6)
      target.shape = KeypointTarget{.pixel = at};
    else
      target.shape = RegionTarget{PixelBox{at.x() - 16, at.y() - 16, 32, 32}};
    targets.push_back(target);
  }
  return targets;
}

/// Frames by number, camera after camera: the n-th arrives at n / (cameras rate) seconds.
class Cameras {
 public:
  explicit Cameras(const Load& load)
      : load_(load),
        scene_(ur5e_scene(Geometry::collision, 640, 480, 615.0, frames, seed)),
        targets_(ten_targets(scene_.intrinsics)),
        latest_(load.cameras) {
    const auto renderer = make_depth_renderer(Backend::cpu, scene_.intrinsics, scene_.bodies(), {});
    depth_ = sensor_images(*renderer, scene_);
    Camera camera{scene_.intrinsics, {}, {}, {}};
    camera.T_parent_camera = scene_.T_root_camera;
    for (std::size_t i = 0; i < load.cameras; ++i)
      pipelines_.push_back(std::make_unique<Pipeline>(*scene_.robot, camera));
  }

  void run() {
    start_ = Clock::now();
    std::vector<std::thread> team;
    for (std::size_t i = 0; i < load_.threads; ++i) team.emplace_back([this] { judge_all(); });
    for (std::thread& thread : team) thread.join();
    std::sort(latencies_.begin(), latencies_.end());
    const auto at = [&](double share) {
      return latencies_[static_cast<std::size_t>(share *
                                                 static_cast<double>(latencies_.size() - 1))];
    };
    std::printf(
        "%zu cameras of 640x480 at %.0f Hz, %zu threads, %.0f s: %zu of %zu frames judged; "
        "latency median %.2f, 99 %% %.2f, most %.2f ms; busy %.0f %%; %s, %s\n",
        load_.cameras, rate, load_.threads, load_.seconds, latencies_.size(), sent(), at(0.5),
        at(0.99), at(1.0), busy_ms_ / (10.0 * load_.seconds * static_cast<double>(load_.threads)),
        cpu_model().c_str(), pipelines_[0]->renderer().isa.c_str());
  }

 private:
  [[nodiscard]] std::size_t sent() const {
    return static_cast<std::size_t>(load_.seconds * rate) * load_.cameras;
  }
  [[nodiscard]] Clock::time_point arrival(std::size_t number) const {
    const double s = static_cast<double>(number) / (rate * static_cast<double>(load_.cameras));
    return start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  }

  void judge_all() {
    std::vector<double> latencies;
    double busy = 0.0;
    for (std::size_t n = next_++; n < sent(); n = next_++) {
      const Clock::time_point due = arrival(n);
      if (Clock::now() >= arrival(n + load_.cameras)) continue;  // dropped
      std::this_thread::sleep_until(due);
      const auto begin = Clock::now();
      judge(n % load_.cameras, n / load_.cameras);
      const auto end = Clock::now();
      busy += std::chrono::duration<double, std::milli>(end - begin).count();
      latencies.push_back(std::chrono::duration<double, std::milli>(end - due).count());
    }
    const std::lock_guard lock(mutex_);
    latencies_.insert(latencies_.end(), latencies.begin(), latencies.end());
    busy_ms_ += busy;
  }

  void judge(std::size_t camera, std::size_t number) {
    const std::lock_guard lock(latest_[camera]);
    const std::size_t frame = (number + 7 * camera) % frames;  // each camera sees another pose
    const FrameReport& report = pipelines_[camera]->process(
        {.stamp = static_cast<std::int64_t>(1e9 * static_cast<double>(number) / rate),
         .depth = depth_[frame].view(),
         .pose = {.positions = scene_.joints[frame]},
         .targets = targets_});
    if (report.status != FrameStatus::ok) throw std::logic_error("bad frame");
  }

  Load load_;
  BenchScene scene_;
  std::vector<Target> targets_;
  std::vector<Image<std::uint16_t>> depth_;
  std::vector<std::unique_ptr<Pipeline>> pipelines_;
  std::vector<std::mutex> latest_;  // of the pipelines
  std::atomic<std::size_t> next_{0};
  Clock::time_point start_;
  std::mutex mutex_;
  std::vector<double> latencies_;  // ms
  double busy_ms_ = 0.0;
};

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  try {
    penumbra::bench::Cameras(penumbra::bench::Load(argc, argv)).run();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "camera_load: " << error.what() << '\n';
    return 2;
  }
}
