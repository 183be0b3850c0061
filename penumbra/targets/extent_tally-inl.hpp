// SPDX-License-Identifier: Apache-2.0
// Counts how the pixels of an extent are seen in a frame, and gathers their depths.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include <penumbra/labels/label_work-inl.hpp>
#include <penumbra/targets/region_spans-inl.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// What TargetJudge says of a pixel.
enum class PixelState : std::uint8_t { clear, front, occluded, unknown, other };
inline constexpr std::size_t state_count = 5;

/// Measured depths nearer than `near` are of something that hides the target, robot pixels nearer
/// than that hide it too, those farther than `far` do not. Metres.
struct DepthLimits {
  float near, far;
};

/// From a depth to its limits.
struct LimitRule {
  LimitRule(const labelling::Rule& rule, double depth_margin)
      : a(rule.a), b(rule.b), c(rule.c), margin(static_cast<float>(depth_margin)) {}

  [[nodiscard]] DepthLimits at(float z) const {
    const float e = a + (b + c * z) * z + margin;
    return {z - e, z + e};
  }

  float a, b, c, margin;
};

/// An image's measurements in metres; 0 where there is none.
template <typename T>
class Measured {
 public:
  Measured(ImageView<const T> image, const labelling::Rule& rule)
      : image_(image), range_(std::is_same_v<T, float> ? rule.metres : rule.millimetres) {}

  class Row {
   public:
    Row(const T* row, labelling::MeasuredRange in_range) : depth_(row), range_(in_range) {}

    [[nodiscard]] float operator[](int u) const {
      const float d = metres(u);
      return is_measurement(d) ? d : 0.0f;
    }
    /// Whether there is a measurement before a depth; without branches, for loops of vectors.
    [[nodiscard]] bool is_before(int u, float limit) const {
      const float d = metres(u);
      return is_measurement(d) & (d < limit);
    }
    [[nodiscard]] bool is_past(int u, float limit) const {
      const float d = metres(u);
      return is_measurement(d) & (d > limit);
    }
    [[nodiscard]] bool is_measured(int u) const { return is_measurement(metres(u)); }

   private:
    [[nodiscard]] bool is_measurement(float d) const {
      return (range_.near <= d) & (d <= range_.far);
    }
    [[nodiscard]] float metres(int u) const {
      if constexpr (std::is_same_v<T, float>)
        return depth_[u];
      else
        return static_cast<float>(depth_[u]) * labelling::metres_per_millimetre;
    }

    const T* depth_;
    labelling::MeasuredRange range_;
  };
  [[nodiscard]] Row row(int v) const { return {image_.row(v), range_}; }

 private:
  ImageView<const T> image_;
  labelling::MeasuredRange range_;
};

/// A frame as targets are judged on it.
struct TalliedFrame {
  /// `has_outside`: what was not drawn is outside of what the camera saw (rectified images); else
  /// the robot may lie there.
  TalliedFrame(const LabelledImages& judged, const labelling::Rule& label_rule, bool has_outside);

  [[nodiscard]] bool has_pose() const { return !images.virtual_depth.depth.empty(); }
  [[nodiscard]] bool is_measured() const {
    return std::visit([](const auto& depth) { return !depth.empty(); }, images.measured);
  }
  /// Whether some of the robot may lie in the pixels [u0, u1] x [v0, v1], which may reach past the
  /// image. It may wherever the lens model does not reach.
  [[nodiscard]] bool robot_may_lie_in(int u0, int u1, int v0, int v1) const;
  /// Whether some of it does, or may where it cannot be drawn: in pixels of the image.
  [[nodiscard]] bool robot_lies_in(int u0, int u1, int v) const;

  LabelledImages images;
  const labelling::Rule* rule;
  int width, height;
  bool is_outside_undrawn;
};

/// How many pixels of an extent are hidden by each link.
class LinkCounts {
 public:
  explicit LinkCounts(std::size_t links) : counts_(links) { touched_.reserve(links); }

  void clear();
  /// `value`: of a link image; 0 and what is no link is left out.
  void add(std::size_t value, std::size_t pixels) {
    if (value == 0 || value > counts_.size()) return;
    if (counts_[value - 1] == 0) touched_.push_back(value - 1);
    counts_[value - 1] += pixels;
  }
  /// Writes the links of which there are some, with their share of `pixels`, largest first.
  std::span<const Blame> write(std::size_t pixels, std::vector<Blame>& blame) const;

 private:
  std::vector<std::size_t> counts_;
  std::vector<std::size_t> touched_;
};

/// Pixels by how they are seen.
struct StateCounts {
  [[nodiscard]] std::size_t& operator[](PixelState state) {
    return counts[static_cast<std::size_t>(state)];
  }
  [[nodiscard]] std::size_t operator[](PixelState state) const {
    return counts[static_cast<std::size_t>(state)];
  }

  std::array<std::size_t, state_count> counts{};
};

/// About how many pixels of an extent are asked for their depth: the median of 1,000 depths is off
/// by 4 % of their spread.
inline constexpr std::size_t max_depth_samples = 1000;

/// What the pixels of an extent show, counted.
struct ExtentTally {
  explicit ExtentTally(std::size_t link_count) : links(link_count) {
    depths.reserve(2 * max_depth_samples);  // whatever the extent's outline
  }

  void clear() {
    pixels = {};
    measured = past = 0;
    links.clear();
    depths.clear();
  }

  StateCounts pixels;
  std::size_t measured = 0;   ///< of the clear and front ones: measured at all
  std::size_t past = 0;       ///< of these: past the expected depth
  LinkCounts links;           ///< those that hide
  std::vector<float> depths;  ///< metres: trusted ones, of one pixel in `step`
  int step = 1;
};

/// A target's expected depth, checked.
struct ExpectedDepth {
  std::optional<float> constant;                ///< metres
  std::optional<ImageView<const float>> image;  ///< of every pixel of the extent
  double margin = 0;                            ///< metres

  [[nodiscard]] bool known() const { return constant || image; }
};

class RobotSurroundings;

/// Counts the pixels of an extent on a frame whose pose is known. `robot`, if not null: also
/// gathers measured depths that are labelled clear or front, lie within the limits of the expected
/// depth and cannot be of the robot.
void tally_extent(const TalliedFrame& frame, std::span<const RowSpan> spans,
                  const ExpectedDepth& expected, bool beyond_hides, RobotSurroundings* robot,
                  ExtentTally& tally);

}  // namespace penumbra
