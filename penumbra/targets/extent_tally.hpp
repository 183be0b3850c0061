// SPDX-License-Identifier: Apache-2.0
// Counts the pixels of an extent by state and collects their depths.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
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

/// Computes the limits of a depth.
struct LimitRule {
  LimitRule(const labelling::Rule& rule, double depth_margin)
      : a(rule.a), b(rule.b), c(rule.c), margin(static_cast<float>(depth_margin)) {}

  [[nodiscard]] DepthLimits at(float z) const {
    const float e = a + (b + c * z) * z + margin;
    return {z - e, z + e};
  }

  float a, b, c, margin;
};

/// A frame to judge targets on. One whose evidence is not `measured` needs of its labels only the
/// touched tiles, if all pixels lie within the lens model.
struct TalliedFrame {
  /// `has_outside`: pixels that cannot be rendered are outside the camera's view (rectified
  /// images); else the robot may be there.
  TalliedFrame(const LabelledImages& judged, const labelling::Rule& label_rule, bool has_outside);

  [[nodiscard]] bool has_pose() const { return !images.virtual_depth.depth.empty(); }
  [[nodiscard]] bool is_measured() const { return images.evidence == Evidence::measured; }
  /// Returns whether the robot may lie in a box, clipped to the image. It may lie anywhere outside
  /// the lens model.
  [[nodiscard]] bool robot_may_lie_in(const PixelRectangle& box) const;
  /// The same for pixels of a row in the image, exactly, and for robot up to `far` metres.
  [[nodiscard]] bool robot_lies_in(const RowSpan& pixels, float far) const;
  [[nodiscard]] PixelRectangle image() const { return {0, 0, width, height}; }

  LabelledImages images;
  const labelling::Rule* rule;
  int width, height;
  bool is_outside_undrawn;
};

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
  [[nodiscard]] std::size_t total() const {
    return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  }

  std::array<std::size_t, state_count> counts{};
};

/// The approximate number of depths that are sampled. The median of 1,000 depths is off by 4 % of
/// their spread.
inline constexpr std::size_t max_depth_samples = 1000;

/// The counts and depths of an extent.
struct ExtentTally {
  explicit ExtentTally(std::size_t link_count) : links(link_count) {
    depths.reserve(2 * max_depth_samples);  // enough for any outline
  }

  void clear() {
    pixels = {};
    measured = past = 0;
    links.clear();
    depths.clear();
  }

  StateCounts pixels;
  std::size_t measured = 0;   ///< clear or front, and measured
  std::size_t past = 0;       ///< of these, behind the expected depth
  LinkCounts links;           ///< that hide
  std::vector<float> depths;  ///< metres; trusted depths of one pixel in `step`
  int step = 1;
};

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

class RobotSurroundings;

/// Counts the pixels of an extent; the frame's pose must be known. If `robot` is not null, also
/// collects depths that are labelled clear or front, lie within the limits of the expected depth
/// and cannot be the robot's.
void tally_extent(const TalliedFrame& frame, std::span<const RowSpan> spans,
                  const ExpectedDepth& expected, bool beyond_hides, RobotSurroundings* robot,
                  ExtentTally& tally);

}  // namespace penumbra
