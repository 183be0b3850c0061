// SPDX-License-Identifier: Apache-2.0
// What is seen of a target, what is remembered of it, and the verdict that follows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <penumbra/targets/extent_tally-inl.hpp>
#include <penumbra/targets/region_spans-inl.hpp>
#include <penumbra/targets/target.hpp>
#include <penumbra/targets/trusted_depth-inl.hpp>

namespace penumbra {

/// What verdicts remember of a target.
struct TargetMemory {
  std::uint64_t frame = 0;           ///< in which it was last judged
  Verdict level = Verdict::visible;  ///< visible, partial or hidden: the last of these
  std::vector<RowSpan> extent;       ///< modal: the last whole one; empty: none
  Eigen::Vector2d moved{0, 0};       ///< since then, until the last verdict visible
  double size = 0;                   ///< modal: pixels of the whole target
  std::optional<double> depth;       ///< expected, metres, that the size is of
  bool is_cut = false;               ///< the extent reaches the image's border: there is more of it
};

/// Finds a name without making a string of it.
struct TargetNameHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view name) const {
    return std::hash<std::string_view>{}(name);
  }
};

using TargetMemories =
    std::unordered_map<std::string, TargetMemory, TargetNameHash, std::equal_to<>>;

/// Why the size of a modal target is not known.
enum class SizeUnknown { none, first_near_robot, cut, moved };

/// What is visible of an extent.
struct Visibility {
  [[nodiscard]] double fraction(PixelState state) const;
  /// Of the pixels inside, `count` of them.
  [[nodiscard]] double share(std::size_t count) const;
  [[nodiscard]] double hidden(bool others_hide) const {
    return fraction(PixelState::occluded) + (others_hide ? fraction(PixelState::other) : 0.0);
  }
  [[nodiscard]] std::size_t seen() const {
    return pixels[PixelState::clear] + pixels[PixelState::front];
  }
  /// Whether the sensor looks past where `limit` or more of what is measured is expected.
  [[nodiscard]] bool is_passed(double limit) const {
    return past > 0 && limit < 1 &&
           static_cast<double>(past) >= limit * static_cast<double>(measured);
  }
  /// Whether less than `least` of what is seen is measured.
  [[nodiscard]] bool is_unmeasured(double least) const {
    return static_cast<double>(measured) < least * static_cast<double>(measured + unmeasured);
  }
  /// Counts up to `count` pixels of a state as unknown instead, and reduces `count` by these.
  void mark_unknown(PixelState state, std::size_t& count);
  void mark_all_unknown();  ///< all that is clear or front

  std::size_t covered = 0, inside = 0;
  StateCounts pixels{};                ///< inside
  std::size_t measured = 0, past = 0;  ///< as in ExtentTally
  std::size_t unmeasured = 0;          ///< clear or front, but not measured
  bool is_expected = false;            ///< its depth is
  const LinkCounts* links = nullptr;
  bool has_pose = true;
  SizeUnknown size_unknown = SizeUnknown::none;
  bool is_missing = false;  ///< some of it is not in its mask, and near the robot
};

/// A target and the frame it is judged on.
struct TargetInFrame {
  const TalliedFrame& frame;
  const TargetView& target;
  const ExpectedDepth& expected;
  RobotSurroundings& robot;
  bool wants_depths;  ///< of the extent as it is given

  /// Robot as near as this, in pixels, may hide more than it seems to.
  [[nodiscard]] int reach() const { return robot.reach(); }
};

/// Finds what is visible of extents, as they are given and as they are remembered.
class ExtentObserver {
 public:
  ExtentObserver(int width, int height, std::size_t links, SeenPixels seen_pixels)
      : width_(width),
        height_(height),
        seen_pixels_(std::move(seen_pixels)),
        seen_(width, height),
        last_(width, height),
        seen_tally_(links),
        last_tally_(links) {}

  void fill(const Region& region) {
    seen_.fill(region);
    seen_.keep(seen_pixels_);
  }
  [[nodiscard]] const RegionSpans& seen() const { return seen_; }

  /// Of the region that fill() took: valid until the next call.
  [[nodiscard]] Visibility observe(const TargetInFrame& at, const TargetMemory& memory);

  /// Returns what was counted on the region of the last call, with its depths if they were wanted.
  [[nodiscard]] ExtentTally& tally() { return seen_tally_; }

  /// Remembers the modal extent of the last call, which is visible.
  void remember(const TargetView& target, TargetMemory& memory) const;

 private:
  [[nodiscard]] static Visibility observe_extent(const TargetInFrame& at, const RegionSpans& extent,
                                                 RobotSurroundings* robot, ExtentTally& tally);
  [[nodiscard]] Visibility observe_modal(const TargetInFrame& at, const TargetMemory& memory,
                                         const Visibility& now);
  [[nodiscard]] Visibility compare(const TargetInFrame& at, const TargetMemory& memory,
                                   const Visibility& now, const SpanBox& box);
  [[nodiscard]] bool reaches_border() const;
  [[nodiscard]] Visibility observe_last(const TargetInFrame& at, std::size_t missing);
  [[nodiscard]] bool place_last(const TargetInFrame& at, const TargetMemory& memory,
                                const SpanBox& box);
  [[nodiscard]] bool may_hide_missing(const TargetInFrame& at, const SpanBox& box,
                                      const SpanBox& whole) const;

  int width_, height_;
  SeenPixels seen_pixels_;
  RegionSpans seen_, last_;
  ExtentTally seen_tally_, last_tally_;
  bool touches_robot_ = false;  // the modal extent of the last call
};

/// The verdict, which `memory.level` follows.
[[nodiscard]] Verdict decide(const Visibility& visibility, const TargetThresholds& thresholds,
                             TargetMemory& memory);

}  // namespace penumbra
