// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of judging targets at 1280 x 720: a frame's key points and boxes together, and
// larger regions by their pixels. The robot is the xArm 7 where the data is there, spheres
// otherwise, seen by a sensor with noise and holes.
#include "scenes.hpp"

#include <array>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <penumbra/labels/labels.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra::bench {
namespace {

constexpr std::uint64_t seed = 7;
constexpr std::size_t key_points = 100, boxes = 20;
constexpr double radius = 5, box_size = 32, region_size = 300;  // pixels

/// The first frame of a scene, labelled.
class LabelledFrame {
 public:
  explicit LabelledFrame(const BenchScene& scene)
      : LabelledFrame(scene.intrinsics, scene.bodies(), scene.path.front()) {
    name = scene.name;
  }

  LabelledFrame(const Intrinsics& intrinsics, const std::vector<Body>& bodies,
                const LinkPoses& poses)
      : camera{intrinsics, {}, {}, {}},
        links(bodies.size()),
        renderer_(make_depth_renderer(Backend::cpu, intrinsics, bodies, {})),
        measured_(intrinsics.width(), intrinsics.height()),
        classifier_(intrinsics.width(), intrinsics.height(), rule) {
    const VirtualDepthView robot = renderer_->render(poses);
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0.0F, 4.0F);
    for (int v = 0; v < intrinsics.height(); ++v) {
      for (int u = 0; u < intrinsics.width(); ++u) {
        const float z = robot.depth(u, v);
        const float d = (z > 0 ? 1e3F * z : 2500.0F) + noise(random);
        measured_(u, v) = random() % 100 == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(d);
        if (z > 0) on_robot.emplace_back(u, v);
      }
    }
    images = {classifier_.classify(robot, measured_.view()), robot, measured_.view()};
  }

  std::string name;
  Camera camera;
  LabelRule rule;
  std::size_t links;
  LabelledImages images;
  std::vector<Eigen::Vector2d> on_robot;

 private:
  std::unique_ptr<DepthRenderer> renderer_;
  Image<std::uint16_t> measured_;
  Classifier classifier_;
};

std::shared_ptr<const LabelledFrame> make_frame() {
  if (std::filesystem::exists(data_folder() / "xarm7_realsense"))
    return std::make_shared<LabelledFrame>(xarm7_scene(1));
  const SphereScene spheres(8, 10000);
  const Intrinsics intrinsics(1280, 720, 915, 915, 640, 360);
  auto frame = std::make_shared<LabelledFrame>(intrinsics, spheres.bodies(), spheres.path(1)[0]);
  frame->name = "spheres";
  return frame;
}

struct Case {
  bool at_robot;  ///< every target's middle lies on the robot, else anywhere in the image
  bool has_depth;
  bool wants_points;

  [[nodiscard]] std::string name() const {
    return std::string(at_robot ? "on the robot" : "anywhere") +
           (has_depth ? ", expected depth" : "") + (wants_points ? ", points" : "");
  }
};

class Targets {
 public:
  Targets(const LabelledFrame& frame, const Case& c) {
    std::mt19937_64 random(seed);
    const auto below = [&](double end) {
      return std::uniform_real_distribution<double>(0, end)(random);
    };
    const ImageView<const std::uint8_t>& image = frame.images.labels.labels;
    for (std::size_t i = 0; i < key_points + boxes; ++i) names_.push_back(std::to_string(i));
    for (std::size_t i = 0; i < names_.size(); ++i) {
      Eigen::Vector2d at(below(image.width), below(image.height));
      if (c.at_robot) at = frame.on_robot[random() % frame.on_robot.size()];
      TargetView target;
      target.name = names_[i];
      if (i < key_points)
        target.region = PixelEllipse{at, {radius, radius}, 0};
      else
        target.region = PixelBox{at.x() - box_size / 2, at.y() - box_size / 2, box_size, box_size};
      if (c.has_depth) target.expected_depth = 2.5;
      target.wants_point = c.wants_points;
      target.thresholds.hidden_enter = 1;  // all of them try to have a point
      target.thresholds.unknown_limit = target.thresholds.past_limit = 1;
      all.push_back(target);
    }
  }

  std::vector<TargetView> all;

 private:
  std::vector<std::string> names_;
};

void judge_all(benchmark::State& state, const LabelledFrame& frame, const Case& c) {
  const Targets targets(frame, c);
  TargetJudge judge(frame.camera, frame.rule, frame.links);
  std::size_t pixels = 0, points = 0;
  for (auto _ : state) {
    judge.begin(frame.images);
    pixels = points = 0;
    for (const TargetView& target : targets.all) {
      const Judgement judgement = judge.judge(target);
      pixels += judgement.inside;
      points += judgement.point ? 1 : 0;
    }
  }
  state.counters["pixels"] = static_cast<double>(pixels);
  state.counters["points"] = static_cast<double>(points);
}

/// A region of some 90 000 pixels in the image's middle, of each kind.
struct LargeRegions {
  explicit LargeRegions(const LabelledFrame& frame)
      : mask(frame.camera.intrinsics.width(), frame.camera.intrinsics.height()),
        depth(mask.width(), mask.height()),
        tiles(mask.width(), mask.height()) {
    const double u = mask.width() / 2.0, v = mask.height() / 2.0, half = region_size / 2;
    corners = {{u, v - half}, {u + half, v}, {u, v + half}, {u - half, v}};
    std::uint32_t run = 0;
    for (int x = 0; x < mask.width(); ++x) {
      for (int y = 0; y < mask.height(); ++y) {
        const bool inside = std::max(std::abs(x - u), std::abs(y - v)) < half;
        if (inside) {
          mask(x, y) = 1;
          depth(x, y) = 1.5F;
          tiles.mark(x, y, x, y);
        }
        if (inside != (counts.size() % 2 == 1)) {
          counts.push_back(run);
          run = 0;
        }
        ++run;
      }
    }
    counts.push_back(run);
    regions = {{{"box", PixelBox{u - half, v - half, region_size, region_size}},
                {"ellipse", PixelEllipse{{u, v}, {half, half}, 0.3}},
                {"polygon", PixelPolygon{corners}},
                {"mask", PixelMask{mask.view()}},
                {"run-length mask", RunLengthMask{mask.width(), mask.height(), counts}},
                {"rendered", RenderedRegion{depth.view(), &tiles}}}};
  }

  Image<std::uint8_t> mask;
  Image<float> depth;
  TileMask tiles;
  std::vector<Eigen::Vector2d> corners;
  std::vector<std::uint32_t> counts;
  std::array<std::pair<const char*, Region>, 6> regions;
};

void judge_large(benchmark::State& state, const LabelledFrame& frame, const Region& region,
                 bool wants_point) {
  TargetJudge judge(frame.camera, frame.rule, frame.links);
  TargetView target;
  target.name = "large";
  target.region = region;
  target.wants_point = wants_point;
  target.thresholds.hidden_enter = 1;
  target.thresholds.unknown_limit = target.thresholds.past_limit = 1;
  target.thresholds.point_min_fraction = 0;
  std::size_t pixels = 0;
  for (auto _ : state) {
    judge.begin(frame.images);
    pixels = judge.judge(target).inside;
  }
  const auto all = static_cast<double>(pixels);
  state.counters["pixels"] = all;
  state.counters["ns_per_pixel"] = benchmark::Counter(
      1e-9 * all, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using namespace penumbra::bench;
  benchmark::Initialize(&argc, argv);
  const std::shared_ptr<const LabelledFrame> frame = make_frame();
  const auto large = std::make_shared<const LargeRegions>(*frame);
  benchmark::AddCustomContext("frame", frame->name);
  benchmark::AddCustomContext("robot_pixels", std::to_string(frame->on_robot.size()));
  for (const bool at_robot : {false, true}) {
    for (const bool wants_points : {false, true}) {
      for (const bool has_depth : {false, true}) {
        const Case c{at_robot, has_depth, wants_points};
        benchmark::RegisterBenchmark(
            ("100 key points, 20 boxes: " + c.name()).c_str(),
            [frame, c](benchmark::State& state) { judge_all(state, *frame, c); })
            ->Unit(benchmark::kMicrosecond);
      }
    }
  }
  for (const bool wants_point : {false, true}) {
    for (const auto& [name, region] : large->regions) {
      const std::string title = std::string("large: ") + name + (wants_point ? ", point" : "");
      benchmark::RegisterBenchmark(title.c_str(), [frame, large, one = region,
                                                   wants_point](benchmark::State& state) {
        judge_large(state, *frame, one, wants_point);
      })->Unit(benchmark::kMicrosecond);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
