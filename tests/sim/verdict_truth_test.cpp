// SPDX-License-Identifier: Apache-2.0
// Verdicts against MuJoCo's segmentation: random arms with targets before, behind and beside them.
// Labels, virtual depth and verdicts are Penumbra's; extents, ids and depths are MuJoCo's.
#include "simulated.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <vector>

#include <penumbra/occlusion/target_judge.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::test {
namespace {

using sim::ObjectTruth;
using sim::SimFrame;
using sim::Simulation;

constexpr std::size_t least_pixels = 100;  // of a target: fewer make shares coarse
constexpr float touching = 0.04F;          // metres of depth
constexpr int seeds = 4;

// Without sensor noise what is left are silhouettes, the clean-up's narrow gaps and millimetres.
constexpr double most_mean_error = 0.01, most_p99_error = 0.05;  // of a target's pixels
constexpr double least_right_blame = 0.99;                       // of hidden pixels
// With a D415's noise pixels at edges are unknown or mixed.
constexpr double most_noisy_mean_error = 0.05;

/// What is true of a target, shares of its pixels.
struct Truth {
  double occluded = 0.0, other = 0.0;
  std::vector<double> blame;  // by link
};

/// Whether the target stands in the arm or another target, or so near that a depth camera cannot
/// tell the two apart, which no target in the world does but one that is grasped.
bool touches(const SimFrame& frame, const ObjectTruth& target) {
  for (std::size_t i = 0; i < target.alone.size(); ++i) {
    const float z = target.alone_depth.data()[i], robot = frame.robot_depth.data()[i];
    if (!(z > 0.0F)) continue;
    const bool other = frame.ids.data()[i] != target.id;
    if (robot > 0.0F && std::abs(z - robot) < touching) return true;
    if (other && std::abs(z - frame.true_depth.data()[i]) < touching) return true;
  }
  return false;
}

/// `model_known`: what the robot hides counts where something else is before the robot, too, as it
/// does for a target whose depth is expected. Else what is seen on the pixel counts.
Truth truth_of(const SimFrame& frame, const ObjectTruth& target, std::size_t links,
               bool model_known) {
  Truth truth;
  truth.blame.resize(links);
  const double share = 1.0 / static_cast<double>(target.pixels_alone);
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    if (target.alone.data()[i] == 0) continue;
    const std::int32_t id = frame.ids.data()[i], robot = frame.robot_ids.data()[i];
    const bool robot_before =
        robot > 0 && frame.robot_depth.data()[i] < target.alone_depth.data()[i];
    const bool robot_seen = id > 0 && id < sim::first_object_id;
    if (model_known ? robot_before : robot_seen) {
      truth.occluded += share;
      truth.blame[static_cast<std::size_t>(robot - 1)] += share;
    } else if (id != target.id) {
      truth.other += share;
    }
  }
  return truth;
}

Verdict verdict_of(double hidden) {
  const TargetThresholds t;
  return hidden > t.hidden_enter    ? Verdict::hidden
         : hidden > t.partial_enter ? Verdict::partial
                                    : Verdict::visible;
}

constexpr std::size_t verdicts = 5;

struct Tally {
  std::vector<double> errors;
  double hidden = 0.0, right_blame = 0.0;  // pixels
  std::array<std::array<std::size_t, verdicts>, 3> confusion{};

  void add(const Truth& truth, const Judgement& judged, const ObjectTruth& target) {
    errors.push_back(std::abs(judged.occluded - truth.occluded));
    const auto pixels = static_cast<double>(target.pixels_alone);
    hidden += truth.occluded * pixels;
    for (const Blame& blame : judged.blame)
      right_blame += std::min(blame.fraction, truth.blame[blame.link]) * pixels;
    const double other = judged.hidden_by_other ? truth.other : 0.0;
    ++confusion[static_cast<std::size_t>(verdict_of(truth.occluded + other))]
               [static_cast<std::size_t>(judged.verdict)];
  }
  [[nodiscard]] double mean() const {
    return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  }
  [[nodiscard]] double p99() const {
    std::vector<double> sorted = errors;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() * 99 / 100];
  }
  [[nodiscard]] double same_verdict() const {
    std::size_t same = 0;
    for (std::size_t v = 0; v < confusion.size(); ++v) same += confusion[v][v];
    return static_cast<double>(same) / static_cast<double>(errors.size());
  }
  void print(const char* title) const {
    std::cout << title << ": " << errors.size() << " targets, error of the occluded share mean "
              << mean() << ", p99 " << p99() << ", right blame " << right_blame / hidden
              << ", same verdict " << same_verdict() << '\n';
    std::cout << std::setw(10) << "is \\ said";
    for (std::size_t v = 0; v < verdicts; ++v)
      std::cout << std::setw(12) << to_string(static_cast<Verdict>(v));
    std::cout << '\n';
    for (std::size_t t = 0; t < confusion.size(); ++t) {
      std::cout << std::setw(10) << to_string(static_cast<Verdict>(t));
      for (const std::size_t n : confusion[t]) std::cout << std::setw(12) << n;
      std::cout << '\n';
    }
  }
};

LabelView labels_of(const FrameReport& report) {
  const PixelCounts& n = report.pixels;
  const auto all = static_cast<std::size_t>(report.labels.width) *
                   static_cast<std::size_t>(report.labels.height);
  return {
      report.labels,
      {all - n.front - n.occluded - n.unknown - n.beyond, n.front, n.occluded, n.unknown, n.beyond},
      nullptr};
}

/// By labels alone, and with the depth that each pixel of the target is expected at.
struct Tallies {
  Tally by_labels, by_depth;
  std::size_t touching = 0;
};

class Bench {
 public:
  Bench(std::uint64_t seed, bool noisy)
      : simulation_("random", options(seed, noisy)),
        pipeline_(robot(), simulation_.camera(), config()),
        judge_(simulation_.camera(), pipeline_.rule(), pipeline_.robot().links().size()) {}

  void run(int frames, Tallies& tallies) {
    SimFrame frame;
    for (int i = 0; i < frames && simulation_.next(frame); ++i) {
      const FrameReport& report = pipeline_.process(
          {.stamp = frame.stamp, .depth = frame.depth.view(), .joints = frame.joints});
      ASSERT_EQ(report.status, FrameStatus::ok) << report.message;
      judge_.begin({labels_of(report), report.virtual_depth, frame.depth.view()});
      for (const ObjectTruth& target : frame.objects)
        if (touches(frame, target))
          ++tallies.touching;
        else if (target.pixels_alone >= least_pixels)
          judge(frame, target, tallies);
    }
  }

 private:
  static sim::SimulationOptions options(std::uint64_t seed, bool noisy) {
    sim::SimulationOptions all = without_noise(seed);
    if (noisy) all.depth = sim::DepthNoise::d415();
    all.color = false;
    return all;
  }
  [[nodiscard]] Robot robot() const {
    RobotOptions all;
    all.geometry = Geometry::visual;
    return Robot::load(simulation_.urdf(), all);
  }
  [[nodiscard]] PipelineConfig config() const {
    PipelineConfig all;
    all.T_parent_camera = simulation_.T_base_camera();
    return all;
  }
  void judge(const SimFrame& frame, const ObjectTruth& target, Tallies& tallies) {
    const std::size_t links = pipeline_.robot().links().size();
    TargetView seen;
    seen.name = target.name;
    seen.region = PixelMask{target.alone.view()};
    seen.wants_point = false;
    // What others than the robot hide is not known without an expected depth.
    const Truth by_labels = truth_of(frame, target, links, false);
    if (by_labels.other == 0.0) tallies.by_labels.add(by_labels, judge_.judge(seen), target);
    judge_.forget(target.name);  // frames have nothing to do with each other
    const std::string name = target.name + " with depth";
    seen.name = name;
    seen.region = RenderedRegion{target.alone_depth.view()};
    tallies.by_depth.add(truth_of(frame, target, links, true), judge_.judge(seen), target);
    judge_.forget(name);
  }

  Simulation simulation_;
  Pipeline pipeline_;
  TargetJudge judge_;
};

Tallies judge_all(bool noisy) {
  const int frames = std::getenv("PENUMBRA_FULL") != nullptr ? 1000 : 60;
  Tallies tallies;
  for (int seed = 0; seed < seeds; ++seed) {
    Bench bench(static_cast<std::uint64_t>(seed) + 100, noisy);
    bench.run(frames / seeds, tallies);
  }
  std::cout << frames << " frames; " << tallies.touching
            << " targets that touch something left out\n";
  tallies.by_labels.print("by labels");
  tallies.by_depth.print("with expected depth");
  return tallies;
}

TEST(VerdictTruth, WithoutNoise) {
  PENUMBRA_REQUIRE_SIMULATION();
  const Tallies tallies = judge_all(false);
  for (const Tally* tally : {&tallies.by_labels, &tallies.by_depth}) {
    ASSERT_GT(tally->errors.size(), 200U);
    EXPECT_LT(tally->mean(), most_mean_error);
    EXPECT_LT(tally->p99(), most_p99_error);
    EXPECT_GT(tally->right_blame / tally->hidden, least_right_blame);
    EXPECT_GT(tally->same_verdict(), 0.95);
    // Hidden must never look visible.
    EXPECT_EQ(tally->confusion[static_cast<std::size_t>(Verdict::hidden)]
                              [static_cast<std::size_t>(Verdict::visible)],
              0U);
  }
}

TEST(VerdictTruth, WithADepthCamerasNoise) {
  PENUMBRA_REQUIRE_SIMULATION();
  const Tallies tallies = judge_all(true);
  for (const Tally* tally : {&tallies.by_labels, &tallies.by_depth}) {
    ASSERT_GT(tally->errors.size(), 200U);
    EXPECT_LT(tally->mean(), most_noisy_mean_error);
    EXPECT_EQ(tally->confusion[static_cast<std::size_t>(Verdict::hidden)]
                              [static_cast<std::size_t>(Verdict::visible)],
              0U);
  }
}

}  // namespace
}  // namespace penumbra::test
