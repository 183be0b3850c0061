// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of the cpu renderer and the reference, for work on the kernels.
#include "scenes.hpp"

#include <benchmark/benchmark.h>

#include <penumbra/base/simd_target.hpp>

namespace penumbra::bench {
namespace {

constexpr std::size_t frames = 60;
constexpr std::uint64_t seed = 7;

void render(benchmark::State& state, const BenchScene& scene, Backend backend,
            const RendererOptions& options) {
  const auto renderer = make_depth_renderer(backend, scene.intrinsics, scene.bodies(), options);
  std::size_t frame = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(renderer->render(scene.path[frame]).depth.data);
    frame = (frame + 1) % scene.path.size();
  }
  state.counters["triangles"] = static_cast<double>(renderer->triangle_count());
}

void add(const std::shared_ptr<const BenchScene>& scene, Backend backend,
         const RendererOptions& options, const std::string& name) {
  benchmark::RegisterBenchmark((scene->name + ", " + name).c_str(), [scene, backend, options](
                                                                        benchmark::State& state) {
    render(state, *scene, backend, options);
  })->Unit(benchmark::kMillisecond);
}

void add_all(BenchScene made) {
  const auto scene = std::make_shared<const BenchScene>(std::move(made));
  for (const std::string& isa : simd_target_names()) {
    for (const int threads : {1, 2}) {
      add(scene, Backend::cpu, {.threads = threads, .isa = isa},
          isa + ", threads " + std::to_string(threads));
    }
  }
  add(scene, Backend::reference, {}, "reference");
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using namespace penumbra::bench;
  using penumbra::Geometry;
  benchmark::Initialize(&argc, argv);
  add_all(ur5e_scene(Geometry::collision, 640, 480, 615.0, frames, seed));
  add_all(ur5e_scene(Geometry::collision, 1280, 720, 915.0, frames, seed));
  add_all(xarm7_scene(frames));
  add_all(ur5e_scene(Geometry::visual, 1280, 720, 915.0, frames, seed));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
