// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/base/virtual_depth.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

/// One frame's images, all of one size, as targets are judged on them. They are looked at until
/// the next frame's are given.
struct LabelledImages {
  LabelView labels;
  VirtualDepthView virtual_depth;  ///< empty where the robot's pose is unknown: all is unknown
  DepthView measured;              ///< empty: no points, and nothing is hidden by others
  bool is_blind = false;  ///< the sensor saw nothing: what the robot does not hide is unknown
};

/// A target as it is judged in one frame.
struct TargetView {
  std::string_view name;  ///< what hysteresis and the last whole extent are remembered by
  Region region;
  Extent extent = Extent::amodal;
  /// Metres, ze below; of the whole region. A rendered region has its own. Without it, no pixel is
  /// known to be hidden by others than the robot. With it, what the robot hides is known without
  /// measurement, and robot behind the target hides nothing.
  std::optional<double> expected_depth;
  /// Metres by which the target's surface may lie before or behind its expected depth: half its
  /// thickness, its pose's uncertainty.
  double depth_margin = 0;
  bool wants_point = true;  ///< a point costs more than all the rest
  /// Where the point lies in the image; nothing: the middle of the covered pixels.
  std::optional<Eigen::Vector2d> point_pixel;
  /// How far the target has moved in the image, pixels, since it was last judged visible, where
  /// that is known. Used for modal extents.
  std::optional<Eigen::Vector2d> motion;
  TargetThresholds thresholds;
};

/// A link that hides a target.
struct Blame {
  std::size_t link = 0;  ///< index into the robot's links
  double fraction = 0;   ///< of the pixels inside the image
};

/// What is said of a target. Fractions are of the pixels inside the image and add up to 1, together
/// with hidden_by_other; where no pixel is inside they are 0.
struct Judgement {
  Verdict verdict = Verdict::unknown;
  std::size_t covered = 0;  ///< pixels of the extent, those outside the image too
  std::size_t inside = 0;   ///< pixels of it inside the image
  double occluded = 0;      ///< hidden by the robot, `beyond` too where that hides
  double front = 0;
  double unknown = 0;
  double clear = 0;
  /// By something that is not the robot; nothing where no expected depth or no image is there.
  std::optional<double> hidden_by_other;
  /// Share of pixels, clear or front ones, where the sensor measures anything; nothing where no
  /// image is there, or no pose.
  std::optional<double> measured;
  /// Share of pixels, clear or front ones, where the sensor measures past the expected depth: the
  /// target is not seen there. Nothing as hidden_by_other.
  std::optional<double> seen_past;
  std::span<const Blame> blame;          ///< largest first; valid until the judge's next call
  std::optional<Eigen::Vector3d> point;  ///< optical frame, metres: of trusted depths only
  std::size_t point_pixels = 0;          ///< trusted pixels, as far as they were asked
  double point_spread = 0;               ///< metres: 1.4826 * median absolute deviation
  std::string_view reason;               ///< one line, a constant, for verdict unknown; else empty
};

/// Judges targets on labelled images. Holds what verdicts remember, by the targets' names, until
/// forget(). Allocates nothing per target once its name, and extents of its size, were seen.
///
/// How a pixel of a target is seen. Without an expected depth its label says it: clear, front,
/// occluded, unknown; beyond is occluded, or clear where beyond_hides is false. With the expected
/// depth ze, m = depth_margin + e(ze), virtual depth dV and measured depth d:
///
/// | label | robot before: dV < ze - m | robot about there | robot behind: dV > ze + m |
/// |---|---|---|---|
/// | clear | | clear; other if d < ze - m | |
/// | front | occluded | front; other if d < ze - m | front; other if d < ze - m |
/// | occluded | occluded | unknown; occluded if d < ze - m | clear; occluded if d < ze - m |
/// | beyond | occluded | unknown | clear |
/// | unknown | occluded | unknown | clear |
///
/// "other": hidden by something that is not the robot. beyond is as clear where beyond_hides is
/// false. Robot about as far as the target is not told from it, neither by the model nor by the
/// sensor: it may hide the target, or be what was taken for it.
///
/// hidden = occluded, with hidden_by_other where others_hide. The verdict is unknown without the
/// robot's pose, and where unknown exceeds its limit and the verdict would be another were all
/// unknown pixels hidden; instead of visible, where no more is seen (clear and front) than unknown,
/// and of visible and partial, where none is seen or, with an expected depth, less than
/// min_measured of what is seen is measured, or past_limit or more of what is measured is past the
/// expected depth, d > ze + m. It is out_of_view whatever else is known.
/// Hysteresis goes on from the last verdict that was neither.
///
/// A modal extent is compared with the whole target as it was seen before. The judge remembers the
/// last extent and the average size of about 100 frames in which the robot did not touch the
/// target. A larger extent replaces the size at once; one that is smaller by more than
/// partial_enter is not the whole target and never does. With expected depths the size scales by
/// 1 / depth^2.
/// - The target stands still, or moves by `motion`, and nothing of it is seen outside of where the
///   last whole extent is then: that extent is judged as well, and the worse counts.
/// - What is missing of its size counts as unknown where the robot may hide it: the robot is near
///   the last whole extent, or as near to the mask as what is missing can reach. unknown_limit
///   passes over none of it.
/// - Its size is not known, and the verdict unknown unless what is seen to be hidden decides it:
///   if it was first seen next to the robot; if it was seen at the image's border only (or at that
///   of what the camera saw), and the robot is as near as the target may be large; if it touches
///   the robot without expected depths, and is at another place than expected or larger, as it may
///   have come nearer. Pixels that a lens's pinhole image does not cover count as robot here.
///
/// A point is the median of the trusted depths, of an extent of more than 1,000 pixels those of one
/// pixel in n, so that some 1,000 are asked: measured, labelled clear or front, within m of the
/// expected depth where there is one; and, within edge_margin (LabelRule's, or its default where
/// that is more) of robot whose virtual depths there are n to f, not from n - e(n) to f + k e(f);
/// near pixels that the lens model does not reach, none at all.
/// Verdicts other than visible and partial have none.
class TargetJudge {
 public:
  /// For images of a camera as they come (with its distortion) or of its pinhole part.
  /// Throws InputError as Camera and LabelRule do. `rule`: that of the labels. `links`: how many
  /// the robot has, for blame. `unseen`: not 0 where the images, rectified ones, show nothing that
  /// the camera saw; such pixels count as outside of the image. Looked at during the call only.
  TargetJudge(const Camera& camera, const LabelRule& rule, std::size_t links,
              ImageView<const std::uint8_t> unseen = {});
  ~TargetJudge();
  TargetJudge(TargetJudge&&) noexcept;
  TargetJudge& operator=(TargetJudge&&) noexcept;

  /// Names the frame that is judged next. Throws InputError for images not of the camera's size.
  void begin(const LabelledImages& images);

  /// Judges one target on the frame of begin(), without which it throws std::logic_error. Throws
  /// InputError, which says what is wrong and not of which target, for a region that is none (not
  /// finite, of zero area, a mask of another size), for numbers out
  /// of bounds and for a name that was judged in this frame already.
  [[nodiscard]] Judgement judge(const TargetView& target);

  /// Forgets what was remembered of a target (a new object under an old name).
  void forget(std::string_view name);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
