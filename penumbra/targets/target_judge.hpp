// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

/// One frame's images, all of one size. They must stay valid until the next frame's are passed.
struct LabelledImages {
  LabelView labels;
  VirtualDepthView virtual_depth;  ///< empty if the robot's pose is unknown: all is unknown
  DepthView measured;              ///< empty: no points, and nothing is hidden by other objects
  bool is_blind = false;           ///< no usable depth: whatever the robot does not hide is unknown
};

/// A target in one frame, in pixels.
struct TargetView {
  Region region;
  Extent extent = Extent::amodal;
  /// Metres, for the whole region; a rendered region has its own. With it, robot pixels
  /// behind the target hide nothing, other objects can hide it, and what the robot hides is known
  /// without a measurement.
  std::optional<double> expected_depth;
  /// Metres between the target's surface and its expected depth at most: half its thickness plus
  /// its pose's uncertainty.
  double depth_margin = 0;
  bool wants_point = true;  ///< false saves time
  /// The point's pixel; null: the centroid of the covered pixels.
  std::optional<Eigen::Vector2d> point_pixel;
  /// The target's motion in the image since it was last visible, pixels, if known. For modal
  /// extents.
  std::optional<Eigen::Vector2d> motion;
  TargetThresholds thresholds;
};

/// The pixels [u0, u1) of row v.
struct RowSpan {
  int v, u0, u1;
};

/// What a judge remembers of a target from frame to frame. One for each target; start with a new
/// one for another object.
struct TargetMemory {
  Verdict level = Verdict::visible;  ///< visible, partial or hidden: the last of these
  std::vector<RowSpan> extent;       ///< modal: the last full extent; empty: none
  Eigen::Vector2d moved{0, 0};       ///< motion from then until the last verdict visible
  double size = 0;                   ///< modal: pixels of the whole target, average
  int sizes = 0;                     ///< in that average
  double size_noise = 0;             ///< of a single size: standard deviation / size
  std::optional<double> depth;       ///< expected depth of the size, metres
  bool is_cut = false;               ///< the extent reaches the image's border, so there is more
};

/// A link that hides a target.
struct Blame {
  std::size_t link = 0;  ///< value in the link image - 1
  double fraction = 0;   ///< of the pixels inside the image
};

/// The result for one target. Fractions are of the pixels inside the image; occluded, front,
/// unknown, clear and hidden_by_other add up to 1, or to 0 if no pixel is inside.
struct Judgement {
  Verdict verdict = Verdict::unknown;
  std::size_t covered = 0;  ///< pixels of the extent, including those outside the image
  std::size_t inside = 0;   ///< pixels of it inside the image
  double occluded = 0;      ///< hidden by the robot, including `beyond` if that hides
  double front = 0;
  double unknown = 0;
  double clear = 0;
  /// Hidden by another object; null without an expected depth or a depth image.
  std::optional<double> hidden_by_other;
  /// Clear or front, with a measurement; null without a depth image or pose.
  std::optional<double> measured;
  /// Clear or front, with a measurement behind the expected depth, so that the target is not there.
  /// Null as hidden_by_other.
  std::optional<double> seen_past;
  std::span<const Blame> blame;          ///< largest first; valid until the judge's next call
  std::optional<Eigen::Vector3d> point;  ///< optical frame, metres; from trusted depths only
  std::size_t point_pixels = 0;          ///< trusted pixels, estimated if only some were sampled
  double point_spread = 0;               ///< metres: 1.4826 * median absolute deviation
  std::string_view reason;  ///< one constant line if the verdict is unknown, else empty
};

/// Judges targets on labelled images. Allocates nothing per target once extents of its size were
/// seen.
///
/// docs/targets.md has the rules: "Pixels" the state of each pixel (clear, front, occluded, hidden
/// by another object, unknown), "Modal extents" what is missing from a detector's mask, "Points"
/// which depths are trusted. With hidden = occluded, plus hidden_by_other if others_hide, the first
/// verdict that applies:
/// - out_of_view: no more than min_inside of the extent lies in the image.
/// - unknown: the robot's pose is unknown; or the unknown fraction exceeds its limit, and the
///   verdict would be different if all unknown pixels were hidden.
/// - hidden, partial or visible by the thresholds, with hysteresis from the last such verdict. But
///   visible becomes unknown if no more is seen (clear or front) than unknown. Visible and partial
///   become unknown if nothing is seen or, with an expected depth, if less than min_measured of
///   what is seen is measured, or at least past_limit of what is measured is behind the target.
///
/// For a modal extent, the memory holds the last extent and the mean size over about 100 frames in
/// which the robot did not touch the target. Only the verdicts visible and partial have a point.
class TargetJudge {
 public:
  /// `camera`: of the raw images (with distortion) or of the rectified ones. `rule`: of the labels.
  /// `links`: the largest value of link images. `unseen`: not 0 for pixels of rectified images that
  /// the camera did not see; they count as outside the image. It is read during the call only.
  /// Throws InputError as Camera and LabelRule do.
  TargetJudge(const Camera& camera, const LabelRule& rule, std::size_t links,
              ImageView<const std::uint8_t> unseen = {});
  ~TargetJudge();
  TargetJudge(TargetJudge&&) noexcept;
  TargetJudge& operator=(TargetJudge&&) noexcept;

  /// Sets the frame to judge. Throws InputError for images that do not have the camera's size.
  void begin(const LabelledImages& images);

  /// Judges one target and updates its memory. Throws InputError, without the target's name, for an
  /// invalid region (not finite, without area, a mask of another size) and numbers out of range;
  /// and std::logic_error before begin().
  [[nodiscard]] Judgement judge(const TargetView& target, TargetMemory& memory);

  /// Judges a target without hysteresis and without an earlier extent.
  [[nodiscard]] Judgement judge(const TargetView& target);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
