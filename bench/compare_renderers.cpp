// SPDX-License-Identifier: Apache-2.0
// Times the cpu renderer beside llvmpipe and Embree on the same frames, in one process, on one
// thread, and counts each one's wrong pixels:
// compare_renderers [--rounds N] [--json FILE]. The table goes to stdout.
#include "embree_oracle.hpp"
#include "embree_tracer.hpp"
#include "llvmpipe.hpp"
#include "scenes.hpp"
#include "timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include <penumbra/labels/labels.hpp>

namespace penumbra::bench {
namespace {

using nlohmann::json;

constexpr std::size_t frames = 60;
constexpr std::uint64_t seed = 7;

std::vector<BenchScene> all_scenes() {
  std::vector<BenchScene> scenes;
  scenes.push_back(ur5e_scene(Geometry::collision, 640, 480, 615.0, frames, seed));
  scenes.push_back(ur5e_scene(Geometry::collision, 1280, 720, 915.0, frames, seed));
  scenes.push_back(xarm7_scene(frames));
  scenes.push_back(ur5e_scene(Geometry::visual, 1280, 720, 915.0, frames, seed));
  return scenes;
}

/// One way of making a depth image. `draw` takes a frame's index.
struct Contender {
  std::string name;
  std::function<ImageView<const float>(std::size_t)> draw;
};

/// How many pixels of some frames are wrong by the rule of DESIGN section 5, silhouettes included.
struct Accuracy {
  std::size_t robot_pixels = 0;
  std::size_t coverage_differs = 0;
  std::size_t depth_differs = 0;  // by more than 0.1 mm at 1 m
};

Accuracy accuracy_of(const Contender& contender, const BenchScene& scene) {
  Accuracy sum;
  for (const std::size_t frame : {std::size_t{0}, scene.path.size() / 2}) {
    const test::EmbreeOracle oracle(scene.bodies(), scene.path[frame]);
    const test::OracleImage expected = test::cast_image(oracle, scene.intrinsics);
    const ImageView<const float> drawn = contender.draw(frame);
    for (int v = 0; v < drawn.height; ++v) {
      for (int u = 0; u < drawn.width; ++u) {
        const double z = expected.depth(u, v);
        sum.robot_pixels += z > 0 ? 1 : 0;
        if ((z > 0) != (drawn(u, v) > 0)) {
          ++sum.coverage_differs;
        } else if (std::abs(drawn(u, v) - z) > 1e-4 * z) {
          ++sum.depth_differs;
        }
      }
    }
  }
  return sum;
}

/// Rounds over all frames, the contenders in turn, so that a disturbance meets all of them.
std::map<std::string, FrameTimes> time_all(const std::vector<Contender>& contenders,
                                           const BenchScene& scene, int rounds) {
  std::map<std::string, FrameTimes> times;
  for (int round = 0; round < rounds; ++round) {
    for (const Contender& contender : contenders) {
      auto& of = times.try_emplace(contender.name, scene.path.size()).first->second;
      contender.draw(scene.path.size() - 1);
      for (std::size_t frame = 0; frame < scene.path.size(); ++frame) {
        of.add(frame, time_ms([&] { contender.draw(frame); }));
      }
    }
  }
  return times;
}

/// Everything that is timed on one scene.
class SceneBench {
 public:
  explicit SceneBench(const BenchScene& scene)
      : scene_(scene),
        bodies_(scene.bodies()),
        llvmpipe_(scene.intrinsics, bodies_),
        embree_(scene.intrinsics, bodies_) {
    for (const std::string& isa : isas_) {
      renderers_.push_back(
          make_depth_renderer(Backend::cpu, scene.intrinsics, bodies_, {.threads = 1, .isa = isa}));
      classifiers_.emplace_back(scene.intrinsics.width(), scene.intrinsics.height(), LabelRule{},
                                isa);
    }
    sensor_ = sensor_images(*renderers_.front(), scene);
  }

  [[nodiscard]] std::vector<Contender> contenders() {
    std::vector<Contender> all;
    for (std::size_t i = 0; i < isas_.size(); ++i) {
      all.push_back({"cpu " + isas_[i], [this, i](std::size_t frame) {
                       return renderers_[i]->render(scene_.path[frame]).depth;
                     }});
      all.push_back({"cpu " + isas_[i] + " + labels", [this, i](std::size_t frame) {
                       const VirtualDepthView view = renderers_[i]->render(scene_.path[frame]);
                       static_cast<void>(classifiers_[i].classify(view, sensor_[frame].view()));
                       return view.depth;
                     }});
    }
    all.push_back(
        {"llvmpipe", [this](std::size_t frame) { return llvmpipe_.render(scene_.path[frame]); }});
    all.push_back(
        {"Embree", [this](std::size_t frame) { return embree_.render(scene_.path[frame]); }});
    return all;
  }

  [[nodiscard]] std::string opengl() const { return llvmpipe_.description(); }
  [[nodiscard]] std::size_t triangles() const { return renderers_.front()->triangle_count(); }

 private:
  const BenchScene& scene_;
  std::vector<Body> bodies_;
  LlvmpipeRenderer llvmpipe_;
  EmbreeTracer embree_;
  std::vector<std::string> isas_ = compared_isas();
  std::vector<std::unique_ptr<DepthRenderer>> renderers_;
  std::vector<Classifier> classifiers_;
  std::vector<Image<std::uint16_t>> sensor_;
};

json run(const BenchScene& scene, int rounds) {
  SceneBench bench(scene);
  const std::vector<Contender> contenders = bench.contenders();
  const auto times = time_all(contenders, scene, rounds);
  json result{{"scene", scene.name}, {"triangles", bench.triangles()}, {"opengl", bench.opengl()}};
  std::printf("\n%s: %zu triangles\n", scene.name.c_str(), bench.triangles());
  std::printf("%-20s %9s %9s | %10s %10s of %s\n", "ms per frame", "typical", "median", "coverage",
              "depth", "robot pixels differ from the oracle");
  for (const Contender& contender : contenders) {
    const FrameTimes& own = times.at(contender.name);
    const Accuracy accuracy = accuracy_of(contender, scene);
    std::printf("%-20s %9.3f %9.3f | %10zu %10zu of %zu\n", contender.name.c_str(), own.typical(),
                own.median(), accuracy.coverage_differs, accuracy.depth_differs,
                accuracy.robot_pixels);
    result["contenders"].push_back({{"name", contender.name},
                                    {"typical_ms", own.typical()},
                                    {"median_ms", own.median()},
                                    {"coverage_differs", accuracy.coverage_differs},
                                    {"depth_differs", accuracy.depth_differs},
                                    {"robot_pixels", accuracy.robot_pixels}});
  }
  for (const std::string& isa : compared_isas()) {
    const double ours = times.at("cpu " + isa).typical();
    std::printf("cpu %s is faster than", isa.c_str());
    for (const char* other : {"llvmpipe", "Embree"})
      std::printf(" %s: %.1f times;", other, times.at(other).typical() / ours);
    std::printf("\n");
  }
  std::fflush(stdout);
  return result;
}

void run_all(int rounds, const std::string& json_file) {
  const std::vector<BenchScene> scenes = all_scenes();
  json report{{"cpu", cpu_model()}, {"rounds", rounds}, {"frames", frames}, {"seed", seed}};
  std::cout << "processor: " << cpu_model() << "; one thread each; " << rounds << " rounds of "
            << frames << " frames, a new pose every frame, seed " << seed
            << "\ntypical: median over the frames of each frame's fastest round\n";
  for (const BenchScene& scene : scenes) report["scenes"].push_back(run(scene, rounds));
  if (!json_file.empty()) std::ofstream(json_file) << report.dump(1) << '\n';
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  try {
    const penumbra::bench::Arguments given(argc, argv);
    penumbra::bench::run_all(given.rounds, given.json_file);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "compare_renderers: " << error.what() << '\n';
    return 1;
  }
}
