// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/base/setting.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra {

// Regions: the pixels of a target, also outside the image. A box or polygon that contains no pixel
// centre covers the pixel nearest to its own centre; so does an ellipse without a pixel centre in
// the image.

/// Largest coordinate or length of a region, pixels.
inline constexpr double max_coordinate = 1e9;

/// The pixels whose centres lie in [u, u + width) x [v, v + height).
struct PixelBox {
  double u = 0, v = 0, width = 0, height = 0;
};

/// The pixels whose centres lie inside the outline by the non-zero winding rule. The outline may
/// touch and cross itself. A centre on the outline counts if the inside is to its right or, on a
/// horizontal edge, below it.
struct PixelPolygon {
  static constexpr std::size_t max_corners = 10000;
  std::vector<Eigen::Vector2d> corners;
};

/// The non-zero pixels of an image of the label image's size.
struct PixelMask {
  Shared<ImageView<const std::uint8_t>> mask;
};

/// COCO's run-length mask, column by column from the left, each from the top: alternating runs of
/// pixels outside and inside, starting outside.
struct RunLengthMask {
  int width = 0, height = 0;  ///< of the label image
  std::vector<std::uint32_t> counts;
};

/// The pixels whose centres lie inside an ellipse or on it.
struct PixelEllipse {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes = Eigen::Vector2d::Ones();  ///< pixels, > 0
  double angle = 0;  ///< radians from +u to +v, of the first semi-axis
};

/// An object that was rendered alone: the pixels with depth > 0, metres, which is also the expected
/// depth. Nothing outside the image; always amodal.
struct RenderedRegion {
  static constexpr float max_depth = 1e6f;  ///< metres

  Shared<ImageView<const float>> depth;  ///< of the label image's size
  const TileMask* touched = nullptr;     ///< depth is 0 outside these tiles; null: all are read
};

using Region =
    std::variant<PixelBox, PixelPolygon, PixelMask, RunLengthMask, PixelEllipse, RenderedRegion>;

/// Throws InputError for a region that is invalid in an image of that size.
void check_region(const Region& region, int width, int height);

/// The part of a target that a region covers.
enum class Extent {
  amodal,  ///< all of it, including hidden parts
  modal    ///< the visible part; compared with the whole target as seen before
};

/// What a frame says about things other than the robot.
enum class Evidence {
  measured,     ///< their depth is measured
  none,         ///< it is not, though it should be: what the robot does not hide is unknown
  assumed_free  ///< nothing else hides anything: a camera without depth, and what is planned
};

/// One frame's images, all of one size. They must stay valid until the next frame's are passed.
struct LabelledImages {
  LabelView labels;
  VirtualDepthView virtual_depth;  ///< empty if the robot's pose is unknown: all is unknown
  DepthView measured;              ///< empty unless that is the evidence
  Evidence evidence = Evidence::measured;
  /// Values of the link image where a link of unknown pose could be: it may hide the target or not.
  std::span<const std::uint16_t> unplaced = {};
  /// Why a part of the robot that is not drawn may hide what seems to be seen; empty: all is drawn.
  std::string_view undrawn = {};
  std::string fault = {};  ///< why what is unknown is so; empty: the judge says it
  std::span<const std::string> link_names = {};  ///< by value in the link image - 1
};

/// The thresholds of verdicts, as fractions of the pixels inside the image.
struct TargetThresholds {
  double partial_enter = 0.05;  ///< as in the paper
  double partial_leave = 0.04;
  double hidden_enter = 0.90;
  double hidden_leave = 0.80;
  std::optional<double> unknown_limit;
  double past_limit = 0.5;
  double min_measured = 0.2;
  double min_inside = 0.0;
  bool beyond_hides = true;
  bool others_hide = true;
  std::size_t point_min_pixels = 5;
  double point_min_fraction = 0.2;

  static constexpr auto settings() {
    using T = TargetThresholds;
    return std::tuple(
        Setting("partial_enter", &T::partial_enter, {0, 1}, "",
                "hidden fraction above which visible becomes partial"),
        Setting("partial_leave", &T::partial_leave, {0, 1}, "",
                "hidden fraction up to which it becomes visible again"),
        Setting("hidden_enter", &T::hidden_enter, {0, 1}, "",
                "hidden fraction above which it becomes hidden"),
        Setting("hidden_leave", &T::hidden_leave, {0, 1}, "",
                "hidden fraction up to which it becomes partial again"),
        Setting("unknown_limit", &T::unknown_limit, {0, 1}, "",
                "unknown fraction above which it is unknown, if it decides; none: partial_enter"),
        Setting("past_limit", &T::past_limit, {0, 1}, "",
                "fraction of what is measured that is behind it, from which on it is unknown"),
        Setting("min_measured", &T::min_measured, {0, 1}, "",
                "fraction of its clear and front pixels that must be measured; 0: off"),
        Setting("min_inside", &T::min_inside, {0, 1}, "",
                "out_of_view if at most this fraction of the extent is in the image"),
        Setting("beyond_hides", &T::beyond_hides, {}, "",
                "beyond counts as occluded; else it counts as clear"),
        Setting("others_hide", &T::others_hide, {}, "",
                "occlusion by other objects counts in verdicts"),
        Setting("point_min_pixels", &T::point_min_pixels, {0, 1e9}, "px",
                "trusted depths needed for a point"),
        Setting("point_min_fraction", &T::point_min_fraction, {0, 1}, "",
                "and their fraction of the pixels inside the image"));
  }

  /// Throws InputError with the invalid value unless all fractions are in 0..1, each `leave` is at
  /// most its `enter`, and each `partial` is at most its `hidden`.
  void check() const;
};

/// A target in one frame, in pixels.
struct TargetView {
  Region region;
  Extent extent = Extent::amodal;
  /// Metres, for the whole region; a rendered region has its own. With it, robot pixels
  /// behind the target hide nothing, other objects can hide it, and what the robot hides is known
  /// without a measurement.
  std::optional<double> expected_depth;
  std::optional<double> height = {};  ///< RegionTarget's, which gives the expected depth
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
  std::vector<RowSpan> whole;        ///< modal: the last whole extent; empty: none
  Eigen::Vector2d moved{0, 0};       ///< motion from then until the last verdict visible
  std::optional<double> depth;       ///< its expected depth, metres
};

/// A link that hides a target.
struct Blame {
  std::size_t link = 0;   ///< value in the link image - 1
  double fraction = 0;    ///< of the pixels inside the image
  std::string name = {};  ///< LabelledImages::link_names
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
  std::vector<Blame> blame;              ///< largest first
  std::optional<Eigen::Vector3d> point;  ///< optical frame, metres; from trusted depths only
  std::size_t point_pixels = 0;          ///< trusted pixels, estimated if only some were sampled
  double point_spread = 0;               ///< metres: 1.4826 * median absolute deviation
  std::string reason;                    ///< one line if the verdict is unknown, else empty
};

/// Judges targets on labelled images.
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
/// For a modal extent, the memory holds the last extent that was seen away from the robot. Only the
/// verdicts visible and partial have a point.
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
