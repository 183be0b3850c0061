// SPDX-License-Identifier: Apache-2.0
// What a detector sees of its targets, judged against MuJoCo's segmentation: each target is seen
// once without the arm, then by the pixels that the arm leaves of it. Truth is MuJoCo's.
#include "simulated.hpp"

#include <penumbra/targets/target_judge.hpp>

namespace penumbra::test {
namespace {

using ModalTruth = SimulationTest;

using sim::ObjectTruth;
using sim::SimFrame;
using sim::Simulation;
using Mask = Image<std::uint8_t>;

constexpr int least_pixels = 100;  // of a target: fewer make shares coarse
constexpr int farthest = 60;       // pixels that a target moves, along u and v
constexpr int seeds = 4;
constexpr float apart = 0.05F;  // metres: another object nearer than that can be told by its depth

/// Most that the arm hides of a target that is called visible: partial_enter, and what silhouettes
/// that differ by part of a pixel add.
constexpr double most_hidden = 0.06;

/// How often targets must be called visible, or the test says nothing. What was seen at the border
/// alone is so away from the arm, and most targets are near it.
constexpr std::array<std::size_t, 5> least_visible{50, 50, 50, 2, 50};

/// Where the target was when it was seen whole, and what is known of that.
enum Way { there, moved, moved_unsaid, at_the_border, with_depth, ways };
constexpr std::array<const char*, ways> way_names{
    "seen whole there", "moved since, and said how far", "moved since", "seen at the border alone",
    "seen whole there, its depth expected"};

Mask shifted(const Mask& mask, int du, int dv) {
  Mask all(mask.width(), mask.height());
  for (const auto [u, v] :
       each_pixel(std::max(0, -du), std::max(0, -dv), std::min(mask.width(), mask.width() - du),
                  std::min(mask.height(), mask.height() - dv)))
    all(u + du, v + dv) = mask(u, v);
  return all;
}

bool is_empty(const Mask& mask) {
  return std::all_of(mask.data(), mask.data() + mask.size(), [](auto one) { return one == 0; });
}

/// As the judge, which remembers nothing of what the border may cut.
bool reaches_border(const Mask& mask) {
  constexpr int near = 3;
  for (const auto [u, v] : each_pixel(mask))
    if (mask(u, v) != 0 &&
        (std::min(u, v) < near || u >= mask.width() - near || v >= mask.height() - near))
      return true;
  return false;
}

/// Pixels from the left border up to which a third of the mask's columns reach when it is moved
/// left so far that the others are cut.
int leftwards(const Mask& mask) {
  int first = mask.width(), last = 0;
  for (const auto [u, v] : each_pixel(mask))
    if (mask(u, v) != 0) first = std::min(first, u), last = std::max(last, u);
  return -(first + 2 * (last - first) / 3);
}

/// A target in a frame, as it was before and as it is seen.
struct Case {
  std::string name;
  Way way = there;
  int du = 0, dv = 0;  // by which it was elsewhere
  Mask before, seen;
  double hidden = 0;                 // by the arm, and with_depth by other objects
  std::optional<double> depth = {};  // expected
  double depth_margin = 0;
};

struct Tally {
  std::size_t visible = 0, hidden = 0;  // called visible; in truth hidden
  double missed = 0;                    // most that is hidden of one called visible
};
using Tallies = std::array<Tally, ways>;

class ModalBench {
 public:
  explicit ModalBench(std::uint64_t seed)
      : random_(seeded_random(seed)),
        simulation_("random", without_color(seed, true)),
        pipeline_(simulation_.robot(), simulation_.camera()),
        judge_(simulation_.camera(), pipeline_.rule(), pipeline_.robot().links().size()) {}

  void run(int frames, Tallies& tallies) {
    SimFrame frame;
    for (int i = 0; i < frames && simulation_.next(frame); ++i) {
      const FrameReport& report = pipeline_.process(
          {.stamp = frame.stamp, .depth = frame.depth.view(), .pose = {.positions = frame.joints}});
      ASSERT_EQ(report.status, FrameStatus::ok) << report.message;
      std::vector<Case> cases;
      for (const ObjectTruth& object : frame.objects) add_cases(frame, object, cases);
      judge_alone(frame, cases);
      judge_.begin({{report.labels, {}, nullptr}, report.virtual_depth, frame.depth.view()});
      for (const Case& one : cases) judge(one, tallies[one.way]);
    }
  }

 private:
  int number(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }

  void add_cases(const SimFrame& frame, const ObjectTruth& object, std::vector<Case>& cases) {
    if (object.pixels_alone < least_pixels) return;
    Mask seen(frame.ids.width(), frame.ids.height());
    std::size_t hidden = 0;
    std::vector<float> depths, others;  // of the object, and before it
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const std::int32_t id = frame.ids.data()[i];
      seen.data()[i] = id == object.id ? 1 : 0;
      if (object.alone.data()[i] == 0) continue;
      depths.push_back(object.alone_depth.data()[i]);
      hidden += is_robot(id) ? 1 : 0;
      if (id != object.id && !is_robot(id)) others.push_back(frame.true_depth.data()[i]);
    }
    if (is_empty(seen)) return;  // no detector finds it
    for (const Way way : {there, moved, moved_unsaid, at_the_border, with_depth}) {
      Case one{object.name + ", " + way_names[way], way, 0, 0, {}, seen, 0.0};
      if (way != there && way != with_depth)
        one.du = number(-farthest, farthest), one.dv = number(-farthest, farthest);
      if (way == at_the_border) one.du = leftwards(object.alone), one.dv = 0;
      one.before = shifted(object.alone, one.du, one.dv);
      if (way == with_depth) {
        const auto [near, far] = std::ranges::minmax(depths);
        one.depth = 0.5 * static_cast<double>(near + far);
        one.depth_margin = 0.5 * static_cast<double>(far - near);
        hidden += static_cast<std::size_t>(std::ranges::count_if(
            others, [&, nearest = near](float z) { return z < nearest - apart; }));
      }
      one.hidden = static_cast<double>(hidden) / static_cast<double>(object.pixels_alone);
      if (way == with_depth && reaches_border(one.before)) continue;
      if (!is_empty(one.before)) cases.push_back(std::move(one));
    }
  }

  /// A frame without the arm.
  void judge_alone(const SimFrame& frame, const std::vector<Case>& cases) {
    const Mask labels(frame.ids.width(), frame.ids.height());
    const Image<float> nothing(frame.ids.width(), frame.ids.height());
    judge_.begin(
        {{labels.view(), {}, nullptr}, {nothing.view(), {}, nullptr}, {}, Evidence::assumed_free});
    for (const Case& one : cases) {
      memories_[one.name] = {};
      EXPECT_EQ(judge_.judge(target_of(one, one.before), memories_[one.name]).verdict,
                Verdict::visible)
          << one.name;
    }
  }

  void judge(const Case& one, Tally& tally) {
    TargetView target = target_of(one, one.seen);
    if (one.way == moved) target.motion = Eigen::Vector2d(-one.du, -one.dv);
    tally.hidden += one.hidden > TargetThresholds().partial_enter ? 1 : 0;
    if (judge_.judge(target, memories_[one.name]).verdict != Verdict::visible) return;
    ++tally.visible;
    tally.missed = std::max(tally.missed, one.hidden);
  }

  static TargetView target_of(const Case& one, const Mask& mask) {
    TargetView target;
    target.expected_depth = one.depth;
    target.depth_margin = one.depth_margin;
    target.region = PixelMask{mask.view()};
    target.extent = Extent::modal;
    target.wants_point = false;
    return target;
  }

  std::mt19937_64 random_;
  Simulation simulation_;
  Pipeline pipeline_;
  TargetJudge judge_;
  std::map<std::string, TargetMemory> memories_;
};

TEST_F(ModalTruth, WithADepthCamerasNoise) {
  const int frames = measures_in_full() ? 1000 : 60;
  Tallies tallies;
  for (int seed = 0; seed < seeds; ++seed) {
    ModalBench bench(static_cast<std::uint64_t>(seed) + 200);
    bench.run(frames / seeds, tallies);
  }
  for (std::size_t way = 0; way < ways; ++way) {
    SCOPED_TRACE(way_names[way]);
    const Tally& tally = tallies[way];
    EXPECT_GT(tally.hidden, 50U) << "or this says nothing";
    EXPECT_GT(tally.visible, least_visible[way]);
    EXPECT_LT(tally.missed, most_hidden);
  }
}

}  // namespace
}  // namespace penumbra::test
