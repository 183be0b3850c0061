// SPDX-License-Identifier: Apache-2.0
// What a detector sees of objects that move, change their size or their track's id while a bar
// sweeps over them: how often nothing is hidden and the verdict is unknown, and what is wrong.
#include "../support/test.hpp"

#include <penumbra/targets/target_judge.hpp>

namespace penumbra::test {
namespace {

constexpr int width = 640, height = 480, frames = 120;
constexpr double focal = 600.0;
constexpr float wall = 3.0f;
constexpr int border = 5;  // pixels: nearer to it an object is not whole

/// Of the frames in which nothing is hidden, the most that are unknown.
constexpr double most_unknown_with_depth = 0.10, most_unknown = 0.20;
/// Hidden by more: partial_enter and the pixels that may be missing unnoticed; the edges of boxes
/// that jitter hold more.
constexpr double most_hidden = 0.10;

/// An upright rectangle, metres, in the optical frame.
struct Object {
  double x, y, z, w, h;
};
struct Rectangle {
  double u0, u1, v0, v1;
  [[nodiscard]] double area() const { return std::max(u1 - u0, 0.0) * std::max(v1 - v0, 0.0); }
  /// What of it is left of a bar between the columns a and b: the wider side.
  [[nodiscard]] Rectangle without(double a, double b) const {
    if (b <= u0 || a >= u1) return *this;
    return a - u0 > u1 - b ? Rectangle{u0, a, v0, v1} : Rectangle{b, u1, v0, v1};
  }
};

enum class Change { moves_away, jumps_back, jitters, gets_another_object };

struct Shares {
  int clear = 0, unknown = 0, hidden = 0, wrong = 0;
};

class MovingTargets : public testing::Test {
 protected:
  double between(double low, double high) { return uniform(random_, low, high); }

  Object object(double width_m, double height_m) {
    const double z = between(0.8, 1.6);
    return {between(-0.25, 0.25) * z, between(-0.15, 0.15) * z, z, width_m, height_m};
  }

  void change(Change how, int frame, const Object& first, double rate, Object& now) {
    if (how == Change::moves_away || how == Change::jumps_back)
      now.z = std::min(now.z * (1 + rate), 0.95 * double(wall));
    if (frame % 60 != 59) return;
    if (how == Change::jumps_back) now = first;
    if (how != Change::gets_another_object) return;
    const double scale = between(0, 1) < 0.5 ? between(1.2, 2.5) : between(0.4, 0.85);
    now = object(scale * now.w, scale * now.h);
  }

  /// Judges a sequence; adds to `with` the verdicts with the object's depth, to `without` others.
  void run(Change how, Shares& with, Shares& without) {
    Object now = object(between(0.08, 0.3), between(0.08, 0.3));
    const Object first = now;
    const double rate = between(0.004, 0.015), period = between(40, 90), bar = between(50, 120);
    const double reach = between(60, 260), jitter = how == Change::jitters ? between(1, 4) : 0.5;
    std::array<TargetMemory, 2> memories;
    for (int i = 0; i < frames; ++i) {
      const double u = 0.5 * width + focal * now.x / now.z, half_w = 0.5 * focal * now.w / now.z;
      const double v = 0.5 * height + focal * now.y / now.z, half_h = 0.5 * focal * now.h / now.z;
      const Rectangle whole{u - half_w, u + half_w, v - half_h, v + half_h};
      const double left = 0.5 * width + reach * std::sin(2 * M_PI * i / period) - 0.5 * bar;
      const Rectangle seen = whole.without(left, left + bar);
      show(whole, now.z, left, left + bar);
      const double both =
          Rectangle{std::max(whole.u0, left), std::min(whole.u1, left + bar), whole.v0, whole.v1}
              .area();
      const bool is_clear = both == 0 && whole.u0 > border && whole.u1 < width - border &&
                            whole.v0 > border && whole.v1 < height - border;
      // A bar in the middle leaves two parts: detectors see one object there, or none.
      if (seen.area() > 30 && seen.u1 - seen.u0 > 3)
        for (const bool has_depth : {false, true}) {
          const auto edge = [&](double at) { return at + between(-jitter, jitter); };
          TargetView target;
          const double u0 = edge(seen.u0), v0 = edge(seen.v0);
          target.region = PixelBox{u0, v0, std::max(edge(seen.u1) - u0, 1.0),
                                   std::max(edge(seen.v1) - v0, 1.0)};
          target.extent = Extent::modal;
          target.depth_margin = 0.05;
          if (has_depth) target.expected_depth = now.z;
          const Verdict verdict = judge_.judge(target, memories.at(has_depth ? 1 : 0)).verdict;
          Shares& shares = has_depth ? with : without;
          shares.clear += is_clear ? 1 : 0;
          shares.unknown += is_clear && verdict == Verdict::unknown ? 1 : 0;
          const bool is_hidden = both > (most_hidden + jitter / half_w) * whole.area();
          shares.hidden += is_hidden ? 1 : 0;
          shares.wrong += is_hidden && verdict == Verdict::visible ? 1 : 0;
        }
      change(how, i, first, rate, now);
    }
  }

  void show(const Rectangle& object, double z, double from, double to) {
    const auto pixel = [](double at, int size) { return std::clamp(int(std::ceil(at)), 0, size); };
    std::fill_n(measured_.data(), measured_.size(), wall);
    std::fill_n(robot_.data(), robot_.size(), 0.0f);
    for (const auto [u, v] : each_pixel(pixel(object.u0, width), pixel(object.v0, height),
                                        pixel(object.u1, width), pixel(object.v1, height)))
      measured_(u, v) = float(z);
    for (const auto [u, v] : each_pixel(pixel(from, width), 0, pixel(to, width), height))
      measured_(u, v) = robot_(u, v) = 0.6f;
    const VirtualDepthView view{robot_.view(), {}, nullptr};
    judge_.begin({classifier_.classify(view, measured_.view()), view, measured_.view()});
  }

  std::mt19937_64 random_ = seeded_random(11);
  Image<float> robot_{width, height}, measured_{width, height};
  Classifier classifier_{width, height, LabelRule{}};
  TargetJudge judge_{Camera{Intrinsics(width, height, focal, focal, 320, 240), {}, {}, {}},
                     LabelRule{}, 1};
};

TEST_F(MovingTargets, AreSeldomUnknownWhereNothingIsHiddenAndNeverVisibleWhereTheyAre) {
  const int sequences = measures_in_full() ? 200 : samples(12);
  for (const auto& [how, name] :
       {std::pair(Change::moves_away, "moves away"), std::pair(Change::jumps_back, "jumps back"),
        std::pair(Change::jitters, "jitters"),
        std::pair(Change::gets_another_object, "gets another object")}) {
    SCOPED_TRACE(name);
    Shares with, without;
    for (int i = 0; i < sequences; ++i) run(how, with, without);
    for (const Shares* of : {&with, &without}) {
      const double unknown = double(of->unknown) / of->clear;
      std::cout << name << (of == &with ? ", with depth: " : ", without: ") << 100 * unknown
                << " % unknown of " << of->clear << " clear, " << of->wrong << " wrong of "
                << of->hidden << " hidden\n";
      EXPECT_LT(unknown, of == &with ? most_unknown_with_depth : most_unknown);
      EXPECT_EQ(of->wrong, 0);
      EXPECT_GT(of->hidden, 0);
    }
  }
}

}  // namespace
}  // namespace penumbra::test
