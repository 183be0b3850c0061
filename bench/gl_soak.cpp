// SPDX-License-Identifier: Apache-2.0
#include "gl_benchmark.hpp"
#include "scenes.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace penumbra::bench {
namespace {

using nlohmann::json;

/// What this process holds of the system.
struct Holdings {
  std::size_t resident_kb = 0;
  std::size_t files = 0;  ///< open descriptors

  static Holdings now() {
    Holdings held;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
      ++held.files;
    std::ifstream statm("/proc/self/statm");
    std::size_t all = 0, resident = 0;
    statm >> all >> resident;
    held.resident_kb = resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) / 1024;
    return held;
  }
};

json repeat(const char* what, std::size_t warm_up, std::size_t times,
            const std::function<void(std::size_t)>& step) {
  for (std::size_t i = 0; i < warm_up; ++i) step(i);
  const Holdings before = Holdings::now();
  for (std::size_t i = 0; i < times; ++i) step(i);
  const Holdings after = Holdings::now();
  std::printf("%zu %s: resident %zu -> %zu kB, open files %zu -> %zu\n", times, what,
              before.resident_kb, after.resident_kb, before.files, after.files);
  std::fflush(stdout);
  return {{"what", what},
          {"times", times},
          {"resident_kb", {before.resident_kb, after.resident_kb}},
          {"files", {before.files, after.files}}};
}

}  // namespace

json soak(const GlSettings& s) {
  constexpr std::size_t frames = 10'000, cycles = 1'000;
  const BenchScene scene = ur5e_scene(Geometry::collision, 640, 480, 615.0, s.frames, s.seed);
  const std::vector<Body> bodies = scene.bodies();
  const auto poses = [&](std::size_t i) -> const LinkPoses& {
    return scene.path[i % scene.path.size()];
  };
  const auto make = [&] {
    return make_depth_renderer(Backend::gl, scene.intrinsics, bodies, s.gl);
  };
  std::printf("\nsoak, %s\n", scene.name.c_str());
  json rows;
  const auto renderer = make();
  rows.push_back(repeat("frames", 200, frames,
                        [&](std::size_t i) { static_cast<void>(renderer->render(poses(i))); }));
  rows.push_back(repeat("renderers made, used and dropped", 20, cycles,
                        [&](std::size_t i) { static_cast<void>(make()->render(poses(i))); }));
  return rows;
}

}  // namespace penumbra::bench
