// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// Returns the colour of a verdict, distinguishable with any common colour blindness.
[[nodiscard]] Rgb8 verdict_color(Verdict verdict);

/// At most this many targets get a name; the others get outlines only.
inline constexpr std::size_t max_target_names = 40;

using PixelPath = std::vector<Eigen::Vector2d>;

/// Poses of the drawn frame and of the target's frame, which is another one if the target is late.
struct TargetPoses {
  std::optional<Eigen::Isometry3d> T_root_camera;       ///< of the frame that is drawn
  std::optional<Eigen::Isometry3d> T_root_camera_then;  ///< of the target's
  std::span<const Eigen::Isometry3d> T_root_link_then;
  bool is_late = false;
};

/// Returns lines of a target: borders of its region, edges of its box, the convex outline of its
/// mesh. Empty if it cannot be drawn.
[[nodiscard]] std::vector<PixelPath> outline_of(const TargetShape& shape, const TargetPoses& poses,
                                                const Robot& robot, const Camera& camera);

/// The lines of a target, in pixels.
struct TargetMark {
  std::vector<PixelPath> outline;        ///< empty if it cannot be drawn
  std::optional<Eigen::Vector2d> place;  ///< place of a handled target
};

/// Draws the targets of one frame after another.
class TargetOverlay {
 public:
  /// Returns a mark for each of a frame's targets. A late 3-D target is drawn at its place at its
  /// own stamp, as the camera sees it now, if the frame of that stamp was drawn. `camera`: of the
  /// report's images.
  [[nodiscard]] std::vector<TargetMark> marks(std::span<const Target> targets,
                                              const FrameReport& report, const Robot& robot,
                                              const Camera& camera);

  /// Draws the marks of a frame's targets in their verdicts' colours, with name and verdict. `out`
  /// has the size of the report's images.
  void draw(std::span<const Target> targets, const FrameReport& report, const Robot& robot,
            const Camera& camera, Image<Rgb8>& out);

 private:
  struct Poses {
    std::optional<Eigen::Isometry3d> T_root_camera;
    std::vector<Eigen::Isometry3d> T_root_link;
  };
  void remember(const FrameReport& report);
  [[nodiscard]] TargetPoses poses_of(const TargetReport& target, const FrameReport& report) const;

  std::map<std::int64_t, Poses> recent_;  // by stamps, as long as late targets may be
};

}  // namespace penumbra::io
