// SPDX-License-Identifier: Apache-2.0
#include "contender.hpp"
#include "gl_benchmark.hpp"
#include "scenes.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace penumbra::bench {
namespace {

using nlohmann::json;

struct Frames {
  std::string axis, value;
  Intrinsics intrinsics;
  std::vector<Body> bodies;
  const std::vector<LinkPoses>& path;
};

/// Where two renderers' images of one frame differ, by the rule of compare_renderers.
json difference(const VirtualDepthView& view, const VirtualDepthView& expected) {
  std::size_t robot_pixels = 0, coverage = 0, depth = 0;
  for (int v = 0; v < view.depth.height; ++v) {
    for (int u = 0; u < view.depth.width; ++u) {
      const double z = expected.depth(u, v);
      robot_pixels += z > 0 ? 1 : 0;
      if ((z > 0) != (view.depth(u, v) > 0)) {
        ++coverage;
      } else if (std::abs(view.depth(u, v) - z) > 1e-4 * z) {
        ++depth;
      }
    }
  }
  return {{"robot_pixels", robot_pixels}, {"coverage_differs", coverage}, {"depth_differs", depth}};
}

Contender contender_of(const std::string& name, DepthRenderer& renderer,
                       const std::vector<LinkPoses>& path) {
  return {name, [&](std::size_t frame) { renderer.submit(path[frame]); },
          [&] { static_cast<void>(renderer.collect()); }, renderer.max_pending()};
}

json compare(const Frames& f, const GlSettings& settings) {
  const auto gl = make_depth_renderer(Backend::gl, f.intrinsics, f.bodies, settings.gl);
  std::vector<std::unique_ptr<DepthRenderer>> cpu;
  std::vector<Contender> contenders;
  for (const std::string& isa : compared_isas()) {
    cpu.push_back(make_depth_renderer(Backend::cpu, f.intrinsics, f.bodies, {.isa = isa}));
    contenders.push_back(contender_of("cpu " + isa, *cpu.back(), f.path));
  }
  contenders.push_back(contender_of("gl", *gl, f.path));
  const std::vector<FrameCosts> costs = measure(contenders, f.path.size(), settings.rounds);

  const LinkPoses& middle = f.path[f.path.size() / 2];
  json row = difference(gl->render(middle), cpu.front()->render(middle));
  row["axis"] = f.axis;
  row["value"] = f.value;
  row["triangles"] = gl->triangle_count();
  std::printf(
      "\n%s: %zu triangles, %zu robot pixels, of which gl and cpu differ in coverage %zu, "
      "in depth %zu",
      f.value.c_str(), gl->triangle_count(), row["robot_pixels"].get<std::size_t>(),
      row["coverage_differs"].get<std::size_t>(), row["depth_differs"].get<std::size_t>());
  print_costs_head("ms per frame");
  for (std::size_t i = 0; i < contenders.size(); ++i)
    row["contenders"].push_back(print_costs(contenders[i], costs[i]));
  return row;
}

json compare(const std::string& axis, const BenchScene& scene, const GlSettings& settings) {
  return compare({axis, axis == "image" ? scene.name.substr(scene.name.find(", ") + 2) : scene.name,
                  scene.intrinsics, scene.bodies(), scene.path},
                 settings);
}

}  // namespace

json compare_frames(const GlSettings& s) {
  json rows;
  rows.push_back(
      compare("frame", ur5e_scene(Geometry::collision, 640, 480, 615.0, s.frames, s.seed), s));
  rows.push_back(compare("frame", xarm7_scene(s.frames), s));
  for (const auto& [width, height] :
       {std::pair{640, 480}, {1280, 720}, {1920, 1080}, {3840, 2160}}) {
    rows.push_back(
        compare("image",
                ur5e_scene(Geometry::collision, width, height, 0.72 * width, s.frames, s.seed), s));
  }
  const Intrinsics camera(1280, 720, 915.0, 915.0, 640.0, 360.0);
  for (const std::size_t triangles : {5000U, 20000U, 100000U, 300000U, 1000000U}) {
    const SphereScene scene(8, triangles);
    const std::vector<LinkPoses> path = scene.path(s.frames);
    rows.push_back(
        compare({"triangles", std::to_string(triangles), camera, scene.bodies(), path}, s));
  }
  return rows;
}

}  // namespace penumbra::bench
