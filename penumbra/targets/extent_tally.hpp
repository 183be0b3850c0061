// SPDX-License-Identifier: Apache-2.0
// Counts the pixels of an extent by state, collects their depths, and says the verdict.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/labels/rule.hpp>
#include <penumbra/targets/region_spans.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// The states of TargetJudge.
enum class PixelState : std::uint8_t { clear, front, occluded, unknown, other };
inline constexpr std::size_t state_count = 5;

[[nodiscard]] inline bool is_seen(PixelState state) {
  return state == PixelState::clear || state == PixelState::front;
}

/// Measurements and robot nearer than `near` hide the target; those farther than `far` are behind
/// it. Metres.
struct DepthLimits {
  float near, far;
};

/// Computes the limits of a depth. The sensor's tolerance is half of it at most: what is nearer
/// than that hides a target however far away it is said to be.
struct LimitRule {
  LimitRule(const labelling::Rule& rule, double depth_margin)
      : a(rule.a), b(rule.b), c(rule.c), margin(static_cast<float>(depth_margin)) {}

  [[nodiscard]] DepthLimits at(float z) const {
    const float e = std::min(a + (b + c * z) * z, 0.5f * z) + margin;
    return {z - e, z + e};
  }

  float a, b, c, margin;
};

/// Returns whether the robot may lie in a box, clipped to the image. It may lie anywhere outside
/// the lens model.
[[nodiscard]] bool robot_may_lie_in(const LabelledImages& images, const PixelRectangle& box);

/// Counts the pixels that each link hides.
class LinkCounts {
 public:
  explicit LinkCounts(std::size_t links) : counts_(links) { touched_.reserve(links); }

  void clear();
  /// `value`: of a link image; 0 and values that are not a link are ignored.
  void add(std::size_t value, std::size_t pixels) {
    if (value == 0 || value > counts_.size()) return;
    if (counts_[value - 1] == 0) touched_.push_back(value - 1);
    counts_[value - 1] += pixels;
  }
  /// Returns the links with pixels, as fractions of `pixels`, largest first. `names`: of links.
  [[nodiscard]] std::vector<Blame> blame(std::size_t pixels,
                                         std::span<const std::string> names) const;

 private:
  std::vector<std::size_t> counts_;
  std::vector<std::size_t> touched_;
};

/// Numbers of pixels by state.
struct StateCounts {
  [[nodiscard]] std::size_t& operator[](PixelState state) {
    return counts[static_cast<std::size_t>(state)];
  }
  [[nodiscard]] std::size_t operator[](PixelState state) const {
    return counts[static_cast<std::size_t>(state)];
  }

  std::array<std::size_t, state_count> counts{};
};

/// The approximate number of depths that are sampled. The median of 1,000 depths is off by 4 % of
/// their spread.
inline constexpr std::size_t max_depth_samples = 1000;

struct ExpectedDepth;
class RobotSurroundings;

/// What the robot and other objects leave of an extent: numbers of pixels, or of rays, and depths.
struct ExtentTally {
  explicit ExtentTally(std::size_t link_count) : links(link_count) {
    depths.reserve(2 * max_depth_samples);  // enough for any outline
  }

  void clear();
  /// Counts the pixels of an extent, all but `covered`; the frame's pose must be known. Images
  /// whose evidence is not `measured` need of their labels only the touched tiles, if all pixels
  /// lie within the lens model. If `robot` is not null, also collects depths that are labelled
  /// clear or front, lie within the limits of the expected depth and cannot be the robot's.
  void count(const LabelledImages& images, const labelling::Rule& rule,
             std::span<const RowSpan> spans, const ExpectedDepth& expected, bool beyond_hides,
             RobotSurroundings* robot);
  /// Returns `count` as a fraction of the pixels inside.
  [[nodiscard]] double share(std::size_t count) const {
    return inside == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(inside);
  }
  [[nodiscard]] double fraction(PixelState state) const { return share(pixels[state]); }
  [[nodiscard]] double hidden(bool others_hide) const {
    return fraction(PixelState::occluded) + (others_hide ? fraction(PixelState::other) : 0.0);
  }
  [[nodiscard]] std::size_t seen() const {
    return pixels[PixelState::clear] + pixels[PixelState::front];
  }
  /// Returns whether at least `limit` of the measured pixels are behind the expected depth.
  [[nodiscard]] bool is_passed(double limit) const {
    return past > 0 && limit < 1 &&
           static_cast<double>(past) >= limit * static_cast<double>(measured);
  }
  /// Returns whether less than `least` of what is seen is measured.
  [[nodiscard]] bool is_unmeasured(double least) const {
    return static_cast<double>(measured) < least * static_cast<double>(measured + unmeasured);
  }
  [[nodiscard]] bool is_out_of_view(const TargetThresholds& thresholds) const {
    return static_cast<double>(inside) <= thresholds.min_inside * static_cast<double>(covered);
  }
  /// Turns up to `count` pixels of a state into unknown, and subtracts them from `count`.
  void mark_unknown(PixelState state, std::size_t& count);

  std::size_t covered = 0, inside = 0;  ///< as in Judgement
  StateCounts pixels;                   ///< inside
  std::size_t measured = 0;             ///< clear or front, and measured
  std::size_t past = 0;                 ///< of these, behind the expected depth
  std::size_t unmeasured = 0;           ///< clear or front, and not measured, though depth is
  LinkCounts links;                     ///< that hide
  std::vector<float> depths;            ///< metres; trusted depths of one pixel in `step`
  int step = 1;
  std::size_t needed = 0;    ///< of fewer pixels inside, nothing is known
  bool is_expected = false;  ///< its depth is known
  bool has_pose = true;
  bool has_whole = true;      ///< how much of it the robot may hide is known
  bool is_missing = false;    ///< its mask lacks pixels near the robot
  bool is_uncovered = false;  ///< most that is unknown lies where the lens model does not reach
};

/// Returns the judgement of a tally by these thresholds, without a point, and updates
/// `memory.level`.
[[nodiscard]] Judgement judgement_of(const ExtentTally& tally, const LabelledImages& images,
                                     const TargetThresholds& thresholds, TargetMemory& memory);

/// Takes back what seems to be seen if a part of the robot is not drawn: it may be hidden by it,
/// and any depth may be its own.
void distrust(const LabelledImages& images, Judgement& judgement);

/// Throws InputError for numbers out of range, and for what a rendered region cannot have.
void check_view(const TargetView& target);

/// A target's expected depth, checked.
struct ExpectedDepth {
  std::optional<float> constant;                ///< metres
  std::optional<ImageView<const float>> image;  ///< for every pixel of the extent
  int u0 = 0, v0 = 0;                           ///< the image's first pixel
  double margin = 0;                            ///< metres

  [[nodiscard]] bool known() const { return constant || image; }
};

/// Calls f(u0, u1, touched) for the parts of a span inside and outside the tiles.
template <typename F>
void for_each_part(const TileMask* tiles, const RowSpan& span, F&& f) {
  if (tiles == nullptr) return f(span.u0, span.u1, true);
  const int shift = std::countr_zero(static_cast<unsigned>(tiles->tile_width));
  const std::uint64_t row = tiles->rows[static_cast<std::size_t>(span.v / TileMask::tile_height)];
  for (int u = span.u0; u < span.u1;) {
    const int tile = u >> shift;
    const std::uint64_t bits = row >> tile;
    const bool touched = (bits & 1) != 0;
    const int count = touched ? std::countr_one(bits) : std::countr_zero(bits);
    const int end = tile + count >= 64 ? span.u1 : std::min(span.u1, (tile + count) << shift);
    f(u, end, touched);
    u = end;
  }
}

}  // namespace penumbra
