// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/base/virtual_depth.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/occlusion/labels.hpp>
#include <penumbra/occlusion/target.hpp>

namespace penumbra {

/// One frame's images, all of one size, as targets are judged on them.
struct JudgedImages {
  LabelView labels;
  VirtualDepthView virtual_depth;  ///< empty where the robot's pose is unknown: all is unknown
  DepthView measured;              ///< empty: no points, and nothing is hidden by others
};

/// A target as it is judged in one frame.
struct TargetView {
  std::string_view name;  ///< what hysteresis and the last good extent are remembered by
  Region region;
  Extent extent = Extent::amodal;
  /// Metres; of the whole region. Without it, and without a rendered one, no pixel is known to be
  /// hidden by others than the robot. With it, what the robot hides is known without measurement.
  std::optional<double> expected_depth;
  /// Where the point lies in the image; nothing: the middle of the covered pixels.
  std::optional<Eigen::Vector2d> point_pixel;
  /// How far the target has moved in the image since its last good extent, where that is known.
  std::optional<Eigen::Vector2d> motion;
  TargetThresholds thresholds;
};

/// A link that hides a target.
struct Blame {
  std::size_t link = 0;  ///< index into the robot's links
  double fraction = 0;   ///< of the pixels inside the image
};

/// What is said of a target. Fractions are of the pixels inside the image; those of labels add up
/// to 1 together with hidden_by_other (which is 0 where no expected depth is known).
struct Judgement {
  Verdict verdict = Verdict::unknown;
  std::size_t covered = 0;  ///< pixels of the extent, those outside the image too
  std::size_t inside = 0;   ///< pixels of it inside the image
  double occluded = 0;      ///< by the robot, with `beyond` where that hides
  double front = 0;
  double unknown = 0;
  double clear = 0;
  std::optional<double> hidden_by_other;  ///< nothing where no expected depth is known
  std::span<const Blame> blame;           ///< largest first; valid until the judge's next call
  std::optional<Eigen::Vector3d> point;   ///< optical frame, metres: of trusted depths only
  std::size_t point_pixels = 0;           ///< depths behind the point
  double point_spread = 0;                ///< metres: 1.4826 * median absolute deviation
  std::string_view reason;                ///< one line, for verdict unknown; else empty
};

/// Judges targets on labelled images. Holds what verdicts remember, by the targets' names.
/// Allocates nothing per target once its name, and extents of its size, were seen.
class TargetJudge {
 public:
  /// For images of a camera as they come (`raw`, with its distortion) or of its pinhole part.
  /// Throws InputError as Camera and LabelRule do. `links`: of the robot, for blame.
  TargetJudge(const Camera& camera, const LabelRule& rule, std::size_t links);
  ~TargetJudge();
  TargetJudge(TargetJudge&&) noexcept;
  TargetJudge& operator=(TargetJudge&&) noexcept;

  /// Names the frame that is judged next. Targets refer to it.
  void begin(const JudgedImages& images);

  /// Judges one target on the frame of begin(). Throws InputError for a region that is none: not
  /// finite, of zero area, a polygon that crosses itself, a mask of another size.
  [[nodiscard]] Judgement judge(const TargetView& target);

  /// Forgets what was remembered of a target (a new object under an old name).
  void forget(std::string_view name);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
