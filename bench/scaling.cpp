// SPDX-License-Identifier: Apache-2.0
// How a renderer's time grows with triangles, pixels, links and threads, one axis at a time: the
// cpu backend by SIMD target and, on a machine with OpenGL, the gl backend:
// scaling [--rounds N] [--json FILE].
#include "scenes.hpp"
#include "timing.hpp"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include <nlohmann/json.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::bench {
namespace {

using nlohmann::json;

constexpr std::size_t frames = 40;

struct Measurement {
  double ms;
  std::size_t triangles, robot_pixels;
};

/// `isa`: a SIMD target, or "gl".
Measurement measure(const Intrinsics& intrinsics, const std::vector<Body>& bodies,
                    const std::vector<LinkPoses>& path, const std::string& isa, int rounds,
                    int threads = 1) {
  const bool is_gl = isa == "gl";
  const auto renderer = make_depth_renderer(is_gl ? Backend::gl : Backend::cpu, intrinsics, bodies,
                                            {.threads = threads, .isa = is_gl ? "" : isa});
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

/// The SIMD targets, and "gl" if an OpenGL device works.
std::vector<std::string> compared() {
  std::vector<std::string> all = compared_isas();
  try {
    for (const GlDevice& device : gl_devices()) {
      if (!device.fault.empty()) continue;
      std::cout << "gl: " << device.name << ", OpenGL " << device.version << '\n';
      all.push_back("gl");
      break;
    }
  } catch (const InputError& error) {
    std::cout << error.what() << '\n';
  }
  return all;
}

/// The axis' value, and time by SIMD target.
class Table {
 public:
  Table(json& report, const std::string& axis, std::vector<std::string> columns)
      : rows_(report["axes"][axis]), columns_(std::move(columns)) {
    std::printf("\n%-12s %10s %10s", axis.c_str(), "triangles", "robot px");
    for (const std::string& isa : columns_) std::printf(" %9s", isa.c_str());
    std::printf("   ms\n");
  }

  template <typename Measure>
  void row(const std::string& value, Measure&& measure) {
    json row{{"value", value}};
    for (const std::string& isa : columns_) {
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
  std::vector<std::string> columns_;
};

void scale_triangles(json& report, const std::vector<std::string>& columns, int rounds) {
  const Intrinsics camera(1280, 720, 915.0, 915.0, 640.0, 360.0);
  Table table(report, "triangles", columns);
  for (const std::size_t triangles : {1000U, 3000U, 10000U, 30000U, 100000U, 300000U, 1000000U}) {
    const SphereScene scene(8, triangles);
    table.row(std::to_string(triangles), [&](const std::string& isa) {
      return measure(camera, scene.bodies(), scene.path(frames), isa, rounds);
    });
  }
}

void scale_links(json& report, const std::vector<std::string>& columns, int rounds) {
  const Intrinsics camera(1280, 720, 915.0, 915.0, 640.0, 360.0);
  Table table(report, "links", columns);
  for (const std::size_t links : {1U, 2U, 5U, 10U, 20U, 50U, 100U, 200U}) {
    const SphereScene scene(links, 40000);
    table.row(std::to_string(links), [&](const std::string& isa) {
      return measure(camera, scene.bodies(), scene.path(frames), isa, rounds);
    });
  }
}

void scale_pixels(json& report, const std::vector<std::string>& columns, int rounds) {
  Table table(report, "image", columns);
  for (const auto& [width, height] :
       {std::pair{320, 240}, {640, 480}, {1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}) {
    const BenchScene scene =
        ur5e_scene(Geometry::collision, width, height, 0.72 * width, frames, 7);
    table.row(std::to_string(width) + "x" + std::to_string(height), [&](const std::string& isa) {
      return measure(scene.intrinsics, scene.bodies(), scene.path, isa, rounds);
    });
  }
}

void scale_robots(json& report, const std::vector<std::string>& columns, int rounds) {
  Table table(report, "UR5e", columns);
  for (const std::size_t count : {1U, 2U, 4U, 8U}) {
    const BenchScene scene = ur5e_cell(count, frames, 7);
    table.row(std::to_string(count), [&](const std::string& isa) {
      return measure(scene.intrinsics, scene.bodies(), scene.path, isa, rounds);
    });
  }
}

void scale_threads(json& report, int rounds) {
  const BenchScene scene = ur5e_scene(Geometry::visual, 1280, 720, 915.0, frames, 7);
  Table table(report, "threads", compared_isas());
  for (int threads = 1; threads <= 4; ++threads) {
    table.row(std::to_string(threads), [&](const std::string& isa) {
      return measure(scene.intrinsics, scene.bodies(), scene.path, isa, rounds, threads);
    });
  }
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using namespace penumbra::bench;
  try {
    const auto [rounds, json_file] = Arguments(argc, argv);
    json report{{"cpu", cpu_model()}, {"frames", frames}, {"rounds", rounds}};
    std::cout << "processor: " << cpu_model() << "; " << rounds << " rounds of " << frames
              << " frames, a new pose every frame\n";
    const std::vector<std::string> columns = compared();
    scale_triangles(report, columns, rounds);
    scale_pixels(report, columns, rounds);
    scale_links(report, columns, rounds);
    scale_robots(report, columns, rounds);
    scale_threads(report, rounds);
    if (!json_file.empty()) std::ofstream(json_file) << report.dump(1) << '\n';
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "scaling: " << error.what() << '\n';
    return 1;
  }
}
