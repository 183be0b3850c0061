// SPDX-License-Identifier: Apache-2.0
// A search for what is called visible though it is not: random objects, robots and sensors, of
// which the truth is known pixel by pixel.
#include "target_frame.hpp"

namespace penumbra::test {
namespace {

constexpr int width = TargetFrame::width, height = TargetFrame::height;
constexpr int frames = 40;         // of a sequence
constexpr float noise = 0.005f;    // metres: within the least tolerance, 0.015 m
constexpr double rounding = 1e-9;  // of shares
constexpr int wide_gap = 20;       // pixels: more than the reach of the robot's edges

/// How a target is told where it is.
enum Way { amodal, amodal_with_depth, modal, modal_with_motion, ways };
constexpr std::array<const char*, ways> way_names{"amodal", "amodal with depth", "modal",
                                                  "modal with motion"};

struct Moving {
  int u = 0, v = 0, du = 0, dv = 0;  // pixels; per frame
  int w = 1, h = 1;
  float z = 1;  // metres

  void move() { u += du, v += dv; }
  [[nodiscard]] bool holds(int x, int y) const {
    return x >= u && x < u + w && y >= v && y < v + h;
  }
};

/// A box or an ellipse that is there or not, robots, and a sensor.
struct World {
  [[nodiscard]] bool of_object(int x, int y) const {
    if (!object.holds(x, y)) return false;
    if (!is_round) return true;
    const double a = (x + 0.5 - object.u) * 2 / object.w - 1;
    const double b = (y + 0.5 - object.v) * 2 / object.h - 1;
    return a * a + b * b <= 1;
  }
  [[nodiscard]] float robot_depth(int x, int y) const {
    float z = std::numeric_limits<float>::infinity();
    for (const Moving& part : robot)
      if (part.holds(x, y)) z = std::min(z, part.z);
    return z;
  }
  [[nodiscard]] bool is_hidden(int x, int y) const { return robot_depth(x, y) < object.z; }

  Moving object;
  bool is_round = false, is_there = true;
  std::vector<Moving> robot;
  double holes = 0;         // share of pixels that are not measured
  double object_holes = 0;  // likewise, on the object: dark or shiny
};

/// What is true of the object in a frame, and its pixels.
struct Truth {
  Truth(const World& world, int gap) : whole(width, height), seen(width, height) {
    for (const auto [u, v] : each_pixel(0, 0, width, height)) {
      if (!world.of_object(u, v)) continue;
      whole(u, v) = 1;
      ++inside;
      const bool is_hidden = world.is_hidden(u, v);
      hidden += is_hidden ? 1 : 0;
      seen(u, v) = is_hidden ? 0 : 1;
    }
    is_clear = hidden == 0 && world.object.u >= gap_to_border && world.object.v >= gap_to_border &&
               world.object.u + world.object.w <= width - gap_to_border &&
               world.object.v + world.object.h <= height - gap_to_border;
    if (gap > 0) wear(world, gap);
    left = std::accumulate(seen.data(), seen.data() + seen.size(), 0);
  }

  /// A mask that keeps away from the robot that hides the object.
  void wear(const World& world, int gap) {
    for (const auto [u, v] : each_pixel(0, 0, width, height))
      for (const Moving& part : world.robot)
        if (part.z < world.object.z && u >= part.u - gap && u < part.u + part.w + gap &&
            v >= part.v - gap && v < part.v + part.h + gap)
          seen(u, v) = 0;
  }

  [[nodiscard]] double share() const { return inside == 0 ? 0 : 1.0 * hidden / inside; }

  static constexpr int gap_to_border = 5;
  Image<std::uint8_t> whole, seen;  // 1: of the object; of its mask
  int inside = 0, hidden = 0, left = 0;
  bool is_clear = false;  // all of it is seen, clear of the border
};

class TargetSearch : public testing::Test {
 protected:
  int number(int low, int high) { return low + int(random() % std::uint64_t(high - low + 1)); }
  double share(double low, double high) { return uniform(random, low, high); }
  bool with(double chance) { return share(0, 1) < chance; }

  Moving moving(int least, int largest, int speed) {
    return {number(-20, width),    number(-20, height),    number(-speed, speed),
            number(-speed, speed), number(least, largest), number(least, largest),
            float(share(0.7, 1.7))};
  }

  World world() {
    World all;
    all.object = moving(8, 50, 4);
    all.is_round = with(0.5);
    all.is_there = with(0.85);
    for (int i = number(1, 2); i > 0; --i) all.robot.push_back(moving(10, 70, 6));
    all.holes = with(0.3) ? share(0, 1) : share(0, 0.1);
    all.object_holes = with(0.3) ? share(0, 1) : 0;
    return all;
  }

  void draw(const World& world, TargetFrame& frame) {
    for (const auto [u, v] : each_pixel(0, 0, width, height)) {
      float& z = frame.measured(u, v);
      z = TargetFrame::wall;
      const bool on_object = world.is_there && world.of_object(u, v);
      if (on_object) z = world.object.z;
      z = std::min(z, world.robot_depth(u, v)) + float(share(-noise, noise));
      const bool is_object = on_object && !world.is_hidden(u, v);
      if (with(is_object ? std::max(world.holes, world.object_holes) : world.holes)) z = 0;
    }
    for (std::size_t i = 0; i < world.robot.size(); ++i)
      add(world.robot[i], std::uint16_t(i), frame);
  }

  static void add(const Moving& part, std::uint16_t link, TargetFrame& frame) {
    for (const auto [u, v] :
         each_pixel(std::max(part.u, 0), std::max(part.v, 0), std::min(part.u + part.w, width),
                    std::min(part.v + part.h, height)))
      if (frame.robot(u, v) == 0 || part.z < frame.robot(u, v))
        frame.add_robot(u, v, u + 1, v + 1, part.z, link, false);
  }

  TargetView view(Way way, const World& world, const Truth& truth) {
    TargetView target;
    target.thresholds = thresholds;
    target.region = PixelMask{(way < modal ? truth.whole : truth.seen).view()};
    target.extent = way < modal ? Extent::amodal : Extent::modal;
    if (way == amodal_with_depth || (way >= modal && has_depth))
      target.expected_depth = double(world.object.z);
    if (way == modal_with_motion)
      target.motion = Vector2d(world.object.u - last[way].u, world.object.v - last[way].v);
    return target;
  }

  void judge(Way way, const World& world, const Truth& truth, TargetJudge& judge) {
    const TargetView target = view(way, world, truth);
    const Verdict verdict = judge.judge(target, memories[way]).verdict;
    const bool is_seen = verdict == Verdict::visible || verdict == Verdict::partial;
    behind[way] += truth.share() > most ? 1 : 0;
    if (!world.is_there && target.expected_depth) {
      EXPECT_FALSE(is_seen) << way_names[way] << ", where nothing is";
      ++absent;
    }
    if (verdict != Verdict::visible) return;
    ++visible[way];
    EXPECT_LE(truth.share(), most + rounding)
        << way_names[way] << ", " << truth.hidden << " of " << truth.inside << " pixels hidden";
    last[way] = world.object;
    was_whole[way] = was_whole[way] || truth.is_clear;
  }

  void run(World world) {
    LabelRule rule = with(0.5) ? LabelRule{} : TargetFrame::without_cleanup();
    if (with(0.3)) rule.range = {0.3, 1.8};  // the wall is out of it
    thresholds.unknown_limit.reset();
    if (with(0.5)) thresholds.unknown_limit = 0;
    // What is unknown may be hidden, up to its limit.
    most = thresholds.partial_enter + thresholds.unknown_limit.value_or(thresholds.partial_enter);
    has_depth = with(0.5);
    const int gap = with(0.3) ? number(1, wide_gap) : 0;
    was_whole.fill(false);
    memories.fill({});
    last.fill(world.object);
    TargetJudge judge_all(TargetFrame::camera(), rule, 2);
    for (int i = 0; i < frames; ++i) {
      TargetFrame frame(rule);
      draw(world, frame);
      judge_all.begin(frame.images());
      for (const Way way : {amodal, amodal_with_depth, modal, modal_with_motion}) {
        const Truth truth(world, was_whole[way] ? gap : 0);
        const bool is_found = way < modal ? truth.inside > 0 : truth.left > 0 && !with(0.1);
        if (is_found) judge(way, world, truth, judge_all);
      }
      world.object.move();
      for (Moving& part : world.robot) part.move();
    }
  }

  std::mt19937_64 random = seeded_random(7);
  TargetThresholds thresholds;
  double most = 0;  // that may be hidden of what is visible
  bool has_depth = false;
  std::array<TargetMemory, ways> memories;
  std::array<Moving, ways> last{};                    // where it was when it was last visible
  std::array<bool, ways> was_whole{};                 // when it was visible
  std::array<std::size_t, ways> visible{}, behind{};  // verdicts; truths: hidden by more than that
  std::size_t absent = 0;
};

TEST_F(TargetSearch, NothingHiddenIsCalledVisible) {
  const int sequences = measures_in_full() ? 5000 : samples(100);
  for (int i = 0; i < sequences; ++i) {
    SCOPED_TRACE("sequence " + std::to_string(i));
    run(world());
    if (HasFailure()) return;
  }
  const auto some = std::size_t(samples(100));
  for (std::size_t way = 0; way < ways; ++way) {
    std::cout << way_names[way] << ": visible " << visible[way] << " times, hidden by more than "
              << "its threshold " << behind[way] << " times\n";
    EXPECT_GT(visible[way], 2 * some) << "or the search says nothing";
    EXPECT_GT(behind[way], some / 4);
  }
  EXPECT_GT(absent, 2 * some);
}

}  // namespace
}  // namespace penumbra::test
