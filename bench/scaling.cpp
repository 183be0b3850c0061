// SPDX-License-Identifier: Apache-2.0
// How the cpu renderer's time grows with triangles, pixels, links and threads, one axis at a time:
// scaling [--rounds N] [--json FILE].
#include "scenes.hpp"
#include "timing.hpp"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include <nlohmann/json.hpp>

namespace penumbra::bench {
namespace {

using nlohmann::json;

constexpr std::size_t frames = 40;

struct Measurement {
  double ms;
  std::size_t triangles, robot_pixels;
};

Measurement measure(const Intrinsics& intrinsics, const std::vector<Body>& bodies,
                    const std::vector<LinkPoses>& path, const RendererOptions& options,
                    int rounds) {
  const auto renderer = make_depth_renderer(Backend::cpu, intrinsics, bodies, options);
  FrameTimes times(path.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      times.add(i, time_ms([&] { static_cast<void>(renderer->render(path[i])); }));
    }
  }
  const VirtualDepthView view = renderer->render(path[path.size() / 2]);
  std::size_t pixels = 0;
  for (int v = 0; v < view.depth.height; ++v) {
    for (int u = 0; u < view.depth.width; ++u) pixels += view.depth(u, v) > 0 ? 1 : 0;
  }
  return {times.typical(), renderer->triangle_count(), pixels};
}

/// The axis' value, and time by SIMD target.
class Table {
 public:
  Table(json& report, std::string axis) : rows_(report["axes"][axis]), axis_(std::move(axis)) {
    std::printf("\n%-12s %10s %10s", axis_.c_str(), "triangles", "robot px");
    for (const std::string& isa : compared_isas()) std::printf(" %9s", isa.c_str());
    std::printf("   ms\n");
  }

  template <typename Measure>
  void row(const std::string& value, Measure&& measure) {
    json row{{"value", value}};
    for (const std::string& isa : compared_isas()) {
      const Measurement m = measure(isa);
      if (!row.contains("triangles")) {
        std::printf("%-12s %10zu %10zu", value.c_str(), m.triangles, m.robot_pixels);
        row["triangles"] = m.triangles;
        row["robot_pixels"] = m.robot_pixels;
      }
      std::printf(" %9.4f", m.ms);
      row["ms"][isa] = m.ms;
    }
    std::printf("\n");
    std::fflush(stdout);
    rows_.push_back(row);
  }

 private:
  json& rows_;
  std::string axis_;
};

void scale_triangles(json& report, int rounds) {
  const Intrinsics camera(1280, 720, 915.0, 915.0, 640.0, 360.0);
  Table table(report, "triangles");
  for (const std::size_t triangles : {1000U, 3000U, 10000U, 30000U, 100000U, 300000U, 1000000U}) {
    const SphereScene scene(8, triangles);
    table.row(std::to_string(triangles), [&](const std::string& isa) {
      return measure(camera, scene.bodies(), scene.path(frames), {.threads = 1, .isa = isa},
                     rounds);
    });
  }
}

void scale_links(json& report, int rounds) {
  const Intrinsics camera(1280, 720, 915.0, 915.0, 640.0, 360.0);
  Table table(report, "links");
  for (const std::size_t links : {1U, 2U, 5U, 10U, 20U, 50U, 100U, 200U}) {
    const SphereScene scene(links, 40000);
    table.row(std::to_string(links), [&](const std::string& isa) {
      return measure(camera, scene.bodies(), scene.path(frames), {.threads = 1, .isa = isa},
                     rounds);
    });
  }
}

void scale_pixels(json& report, int rounds) {
  Table table(report, "image");
  for (const auto& [width, height] :
       {std::pair{320, 240}, {640, 480}, {1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}) {
    const BenchScene scene =
        ur5e_scene(Geometry::collision, width, height, 0.72 * width, frames, 7);
    table.row(std::to_string(width) + "x" + std::to_string(height), [&](const std::string& isa) {
      return measure(scene.intrinsics, scene.bodies(), scene.path, {.threads = 1, .isa = isa},
                     rounds);
    });
  }
}

void scale_threads(json& report, int rounds) {
  const BenchScene scene = ur5e_scene(Geometry::visual, 1280, 720, 915.0, frames, 7);
  Table table(report, "threads");
  for (int threads = 1; threads <= 4; ++threads) {
    table.row(std::to_string(threads), [&](const std::string& isa) {
      return measure(scene.intrinsics, scene.bodies(), scene.path, {.threads = threads, .isa = isa},
                     rounds);
    });
  }
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using namespace penumbra::bench;
  int rounds = 5;
  std::string json_file;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--rounds") rounds = std::stoi(argv[i + 1]);
    if (std::string(argv[i]) == "--json") json_file = argv[i + 1];
  }
  try {
    json report{{"cpu", cpu_model()}, {"frames", frames}, {"rounds", rounds}};
    std::cout << "processor: " << cpu_model() << "; " << rounds << " rounds of " << frames
              << " frames, a new pose every frame\n";
    scale_triangles(report, rounds);
    scale_pixels(report, rounds);
    scale_links(report, rounds);
    scale_threads(report, rounds);
    if (!json_file.empty()) std::ofstream(json_file) << report.dump(1) << '\n';
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "scaling: " << error.what() << '\n';
    return 1;
  }
}
