// SPDX-License-Identifier: Apache-2.0
#include "contender.hpp"
#include "gl_benchmark.hpp"
#include "scenes.hpp"

#include <array>
#include <cstdio>
#include <vector>

#include <nlohmann/json.hpp>

#include <penumbra/occlusion/labels.hpp>
#include <penumbra/pipeline/gl/gl_labeller.hpp>

namespace penumbra::bench {
namespace {

using nlohmann::json;

/// The cpu backend and the classifier.
class CpuLabeller {
 public:
  CpuLabeller(const BenchScene& scene, const std::string& isa)
      : renderer_(
            make_depth_renderer(Backend::cpu, scene.intrinsics, scene.bodies(), {.isa = isa})),
        classifier_(scene.intrinsics.width(), scene.intrinsics.height(), LabelRule{}, isa) {}

  LabelView label(const LinkPoses& poses, const DepthView& measured) {
    return classifier_.classify(renderer_->render(poses), measured);
  }
  [[nodiscard]] DepthRenderer& renderer() { return *renderer_; }

 private:
  std::unique_ptr<DepthRenderer> renderer_;
  Classifier classifier_;
};

std::size_t labels_that_differ(ImageView<const std::uint8_t> a, ImageView<const std::uint8_t> b) {
  std::size_t count = 0;
  for (int v = 0; v < a.height; ++v) {
    for (int u = 0; u < a.width; ++u) count += a(u, v) != b(u, v) ? 1 : 0;
  }
  return count;
}

}  // namespace

json compare_labels(const GlSettings& settings) {
  const BenchScene scene = xarm7_scene(settings.frames);
  std::vector<CpuLabeller> cpu;
  for (const std::string& isa : compared_isas()) cpu.emplace_back(scene, isa);
  const std::vector<Image<std::uint16_t>> sensor = sensor_images(cpu[0].renderer(), scene);
  GlLabeller gl(scene.intrinsics, scene.bodies(), LabelRule{}, settings.gl);
  const std::array<gl::PixelRectangle, 1> whole{
      gl::PixelRectangle{0, 0, scene.intrinsics.width(), scene.intrinsics.height()}};

  std::vector<Contender> contenders;
  for (std::size_t i = 0; i < cpu.size(); ++i) {
    contenders.push_back({"cpu " + compared_isas()[i],
                          [&, i](std::size_t frame) {
                            static_cast<void>(
                                cpu[i].label(scene.path[frame], sensor[frame].view()));
                          },
                          [] {}});
  }
  contenders.push_back(
      {"gl", [&](std::size_t frame) { gl.submit(scene.path[frame], sensor[frame].view(), whole); },
       [&] { static_cast<void>(gl.collect()); }, GlLabeller::max_pending});
  const std::vector<FrameCosts> costs = measure(contenders, scene.path.size(), settings.rounds);

  const std::size_t middle = scene.path.size() / 2;
  gl.submit(scene.path[middle], sensor[middle].view(), whole);
  const std::size_t differ =
      labels_that_differ(gl.collect().image.labels,
                         cpu.front().label(scene.path[middle], sensor[middle].view()).labels);
  json report{{"scene", scene.name}, {"labels_differ", differ}};
  std::printf("\n%s, virtual depth and labels; labels that differ: %zu", scene.name.c_str(),
              differ);
  print_costs_head("ms per frame");
  for (std::size_t i = 0; i < contenders.size(); ++i)
    report["contenders"].push_back(print_costs(contenders[i], costs[i]));
  return report;
}

}  // namespace penumbra::bench
