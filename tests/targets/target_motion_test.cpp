// SPDX-License-Identifier: Apache-2.0
// What a detector sees of objects that move, change their size or their track's id while a bar
// sweeps over them: how often nothing is hidden and the verdict is unknown, and what is wrong.
#include "../support/test.hpp"

#include <penumbra/targets/target_judge.hpp>

namespace penumbra::test {
namespace {

constexpr int width = 640, height = 480, frames = 120;
constexpr double focal = 600.0;
constexpr double nearest = 0.7;  // metres, of an object; the bar is at 0.6
constexpr float wall = 3.0f;
constexpr int least_area = 30, least_width = 3;  // pixels of what a detector finds
constexpr int border = 5;                        // pixels: nearer to it an object is not whole

/// Of the frames in which nothing is hidden, the most that are unknown; a few sequences have up to
/// twice as many.
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
  /// Or its ellipse does.
  [[nodiscard]] bool holds(int u, int v, bool is_round) const {
    if (u < u0 || u >= u1 || v < v0 || v >= v1) return false;
    const double a = (2 * u - u0 - u1) / (u1 - u0), b = (2 * v - v0 - v1) / (v1 - v0);
    return !is_round || a * a + b * b <= 1;
  }
  [[nodiscard]] auto pixels() const {
    const auto inside = [](double at, int size) { return std::clamp(int(std::ceil(at)), 0, size); };
    return each_pixel(inside(u0, width), inside(v0, height), inside(u1, width), inside(v1, height));
  }
  /// What of it is left of a bar between the columns a and b: the wider side.
  [[nodiscard]] Rectangle without(double a, double b) const {
    if (b <= u0 || a >= u1) return *this;
    return a - u0 > u1 - b ? Rectangle{u0, a, v0, v1} : Rectangle{b, u1, v0, v1};
  }
};

enum class Change { moves_away, comes_nearer, jumps_back, jitters, gets_another_object };

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
    if (how == Change::comes_nearer) now.z = std::max(now.z / (1 + rate), nearest);
    if (frame % 60 != 59) return;
    if (how == Change::jumps_back) now = first;
    if (how != Change::gets_another_object) return;
    const double scale = between(0, 1) < 0.5 ? between(1.2, 2.5) : between(0.4, 0.85);
    now = object(scale * now.w, scale * now.h);
  }

  /// Judges a sequence of boxes, or of masks of ellipses; adds to `with` the verdicts with the
  /// object's depth, to `without` others.
  void run(Change how, bool is_mask, Shares& with, Shares& without) {
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
      show(whole, is_mask, float(now.z), left, left + bar);
      double all = 0, hidden = 0;
      for (const auto [x, y] : whole.pixels())
        if (whole.holds(x, y, is_mask)) all += 1, hidden += x >= left && x < left + bar ? 1 : 0;
      const bool is_clear = hidden == 0 && whole.u0 > border && whole.u1 < width - border &&
                            whole.v0 > border && whole.v1 < height - border;
      const bool is_hidden = hidden > (most_hidden + jitter / half_w) * all;
      for (const bool has_depth : {false, true}) {
        const auto edge = [&](double at) { return at + between(-jitter, jitter); };
        TargetView target;
        Image<std::uint8_t> mask(width, height);
        // A bar in the middle leaves two parts: detectors box one of them.
        const Rectangle of = is_mask ? whole : whole.without(left, left + bar);
        if (of.area() < least_area || of.u1 - of.u0 < least_width) continue;
        const double u0 = edge(of.u0), v0 = edge(of.v0), gap = edge(0);
        const Rectangle said{u0, std::max(edge(of.u1), u0 + 1), v0, std::max(edge(of.v1), v0 + 1)};
        if (is_mask) {
          int seen = 0;
          for (const auto [x, y] : said.pixels())
            if (said.holds(x, y, true) && (x < left - gap || x >= left + bar + gap))
              mask(x, y) = 1, ++seen;
          if (seen < least_area) continue;
          target.region = PixelMask{mask.view()};
        } else {
          target.region = PixelBox{said.u0, said.v0, said.u1 - said.u0, said.v1 - said.v0};
        }
        target.extent = Extent::modal;
        target.depth_margin = 0.05;
        if (has_depth) target.expected_depth = now.z;
        const Verdict verdict = judge_.judge(target, memories.at(has_depth ? 1 : 0)).verdict;
        Shares& shares = has_depth ? with : without;
        shares.clear += is_clear ? 1 : 0;
        shares.unknown += is_clear && verdict == Verdict::unknown ? 1 : 0;
        shares.hidden += is_hidden ? 1 : 0;
        shares.wrong += is_hidden && verdict == Verdict::visible ? 1 : 0;
      }
      change(how, i, first, rate, now);
    }
  }

  void show(const Rectangle& object, bool is_round, float z, double from, double to) {
    std::fill_n(measured_.data(), measured_.size(), wall);
    std::fill_n(robot_.data(), robot_.size(), 0.0f);
    for (const auto [u, v] : object.pixels())
      if (object.holds(u, v, is_round)) measured_(u, v) = z;
    for (const auto [u, v] : Rectangle{from, to, 0, height}.pixels())
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
  const int sequences = measures_in_full() ? 200 : samples(6);
  const double scatter = measures_in_full() ? 1.0 : 2.0;
  for (const auto& [how, name] :
       {std::pair(Change::moves_away, "moves away"),
        std::pair(Change::comes_nearer, "comes nearer"),
        std::pair(Change::jumps_back, "moves away, and jumps back"),
        std::pair(Change::jitters, "has edges that jitter"),
        std::pair(Change::gets_another_object, "is replaced by another object")})
    for (const bool is_mask : {false, true}) {
      SCOPED_TRACE(std::string(is_mask ? "mask " : "box ") + name);
      Shares with, without;
      for (int i = 0; i < sequences; ++i) run(how, is_mask, with, without);
      std::cout << (is_mask ? "mask " : "box ") << name;
      for (const Shares* of : {&with, &without}) {
        const double unknown = double(of->unknown) / of->clear;
        std::cout << " | " << 100 * unknown << " %, " << of->wrong << " of " << of->hidden;
        EXPECT_LT(unknown, scatter * (of == &with ? most_unknown_with_depth : most_unknown));
        EXPECT_EQ(of->wrong, 0);
        EXPECT_GT(of->hidden, 0);
      }
      std::cout << '\n';
    }
}

}  // namespace
}  // namespace penumbra::test
