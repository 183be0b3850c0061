// SPDX-License-Identifier: Apache-2.0
// The visibility of a target, its memory, and the verdict.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Core>

#include <penumbra/targets/extent_tally.hpp>
#include <penumbra/targets/region_spans.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/targets/trusted_depth.hpp>

namespace penumbra {

/// Throws InputError for numbers out of range, and for what a rendered region cannot have.
void check_view(const TargetView& target);

/// What the robot and other objects leave of an extent: a tally of its pixels or rays, and the
/// verdict.
struct Visibility {
  /// Of a tally, which must live as long.
  Visibility(const ExtentTally& tally, Evidence evidence, std::size_t all, std::size_t in_image,
             bool is_depth_known);

  [[nodiscard]] double fraction(PixelState state) const;
  /// Returns `count` as a fraction of the pixels inside.
  [[nodiscard]] double share(std::size_t count) const;
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
  /// Returns the judgement by these thresholds, without a point, and updates `memory.level`.
  [[nodiscard]] Judgement judge(const LabelledImages& images, const TargetThresholds& thresholds,
                                TargetMemory& memory) const;
  /// Turns up to `count` pixels of a state into unknown, and subtracts them from `count`.
  void mark_unknown(PixelState state, std::size_t& count);
  void mark_all_unknown();  ///< all clear and front pixels

  std::size_t covered, inside;
  StateCounts pixels;          ///< inside
  std::size_t measured, past;  ///< as in ExtentTally
  std::size_t unmeasured = 0;  ///< clear or front, and not measured, though depth is
  bool is_expected;            ///< its depth is known
  const LinkCounts* links;
  std::size_t needed = 0;  ///< of fewer pixels inside, nothing is known
  bool has_pose = true;
  bool has_whole = true;      ///< how much of it the robot may hide is known
  bool is_missing = false;    ///< its mask lacks pixels near the robot
  bool is_uncovered = false;  ///< most that is unknown lies where the lens model does not reach
};

/// Takes back what seems to be seen if a part of the robot is not drawn: it may be hidden by it,
/// and any depth may be its own.
void distrust(const LabelledImages& images, Judgement& judgement);

/// A target and its frame.
struct TargetInFrame {
  const TalliedFrame& frame;
  const TargetView& target;
  const ExpectedDepth& expected;
  RobotSurroundings& robot;
  bool wants_depths;  ///< of the given extent

  /// Distance in pixels within which the robot may hide more than it seems to.
  [[nodiscard]] int reach() const { return robot.reach(); }
};

/// Observes given and remembered extents.
class ExtentObserver {
 public:
  ExtentObserver(int width, int height, std::size_t links, SeenPixels seen_pixels)
      : width_(width),
        height_(height),
        seen_pixels_(std::move(seen_pixels)),
        seen_(width, height),
        whole_(width, height),
        seen_tally_(links),
        whole_tally_(links) {}

  void fill(const Region& region) {
    seen_.fill(region);
    seen_.keep(seen_pixels_);
  }
  [[nodiscard]] const RegionSpans& seen() const { return seen_; }

  /// Returns the expected depth of an object of known height, metres, by the region of fill(), or
  /// the remembered one where a modal region may be cut. `focal`: pixels, vertical.
  [[nodiscard]] std::optional<double> depth_by_height(const TargetInFrame& at,
                                                      const TargetMemory& memory,
                                                      double focal) const;

  /// Observes the region of fill(). The result is valid until the next call.
  /// Forgets the remembered extent if the
  /// region is of another object.
  [[nodiscard]] Visibility observe(const TargetInFrame& at, TargetMemory& memory);

  /// Returns the counts of the last call, with depths if requested.
  [[nodiscard]] ExtentTally& tally() { return seen_tally_; }

  /// Stores the modal extent of the last call, which was visible.
  void remember(const TargetView& target, TargetMemory& memory) const;

 private:
  [[nodiscard]] static Visibility observe_extent(const TargetInFrame& at, const RegionSpans& extent,
                                                 RobotSurroundings* robot, ExtentTally& tally);
  [[nodiscard]] Visibility observe_modal(const TargetInFrame& at, TargetMemory& memory,
                                         const Visibility& now);
  [[nodiscard]] bool place_whole(const TargetInFrame& at, const TargetMemory& memory,
                                 const PixelRectangle& box);
  [[nodiscard]] Visibility observe_whole(const TargetInFrame& at, std::size_t missing);
  [[nodiscard]] bool reaches_border() const;

  int width_, height_;
  SeenPixels seen_pixels_;
  RegionSpans seen_, whole_;
  ExtentTally seen_tally_, whole_tally_;
  // Of the last modal extent:
  Eigen::Array2d whole_size_{0, 0};  // pixels, of the remembered extent; 0: none
  Eigen::Vector2d moved_{0, 0};      // of that
  bool is_near_robot_ = false;
};

}  // namespace penumbra
