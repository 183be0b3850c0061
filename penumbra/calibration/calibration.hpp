// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/calibration/kept_frames.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

struct CalibrationOptions {
  std::string camera_parent;  ///< link that carries the camera; empty: the root
  /// The camera's pose in that link, at most 100 mm and 10 degrees off; null: it is searched for.
  std::optional<Eigen::Isometry3d> initial;
  bool focal = false;  ///< estimate the focal lengths, too
  /// Estimate the zero offsets of joints that the images contradict; needs depth.
  bool joint_offsets = false;
  /// Estimate the time between images and poses, too; needs depth, and poses around the frames.
  bool time_offset = false;
  /// Standard deviation of the zeros of joints, rad (m of sliding ones). Published errors of
  /// industrial arms are 0.002 to 0.007; hobby servos repeat to 0.02 or 0.03.
  double joint_accuracy = 0.005;
  /// The widest 95 % region of a good pose, metres, and as many rad; null: 0.03, without depth 0.06
  /// m and 0.03 rad.
  std::optional<double> accept = {};
  std::uint64_t seed = 1;  ///< of the poses that are tried
};

/// A small motion of the camera in its own frame: rotation (rad) in x, y, z, then translation (m).
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// How well the robot fits a frame.
struct FrameFit {
  std::size_t index = 0;  ///< KeptFrame::index
  bool used = true;       ///< false: the robot is elsewhere than its joints say
  /// Share of the robot's measured pixels at its depth; without depth, intersection over union of
  /// robot and mask.
  double agreeing = 0.0;
  double residual = 0.0;  ///< median distance of measured points from the robot's surface, metres
  double outline = 0.0;  ///< median distance of the depth's or mask's edge from the outline, pixels
};

/// A value and its standard deviation.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;
};

struct Calibration {
  Eigen::Isometry3d T_parent_camera;
  /// Of T_parent_camera: what joints' zeros within CalibrationOptions::joint_accuracy do, the
  /// residuals' own, and what errors common to a frame or a link do. It covers the pose that each
  /// cause in `notes` gives.
  PoseCovariance covariance;
  /// Metres: measured = true (1 + depth_scale) + depth_offset; neither without depth.
  std::optional<Estimate> depth_offset, depth_scale;
  Estimate outline;  ///< pixels by which the depth's or mask's picture of the robot is larger
  /// Pixels by which the depth image lies to the right of and below the colour image; only with
  /// depth and masks, and then the pose is that of the colour image.
  std::optional<Estimate> shift_right, shift_down;
  /// Relative: fx and fy are 1 + this of the camera's; only with CalibrationOptions::focal. The
  /// same for both without depth.
  std::optional<Estimate> focal_x, focal_y;
  /// Order of Robot::variables(), rad or m; empty: not asked. Those that the images do not
  /// contradict stay 0.
  std::vector<Estimate> joint_offsets;
  /// Seconds to add to an image's stamp before poses are looked up.
  std::optional<Estimate> time_offset;
  std::vector<FrameFit> frames;
  std::vector<double> link_residuals;  ///< signed medians by link, metres; NaN: not seen
  double mask_overlap = 0.0;           ///< intersection over union with the masks; 0 without masks

  /// Why the pose must not be used and what helps, a line each; empty: it is good.
  std::vector<std::string> faults;
  /// Frames that were left out, and inputs that the images contradict, with the amount: a focal
  /// length, a joint's zero, the time of the poses, the sensor's depth.
  std::vector<std::string> notes;
  std::string advice;    ///< what is known least, and which joints' motion would add most
  bool is_wide = false;  ///< the only fault: the region is wider than CalibrationOptions::accept

  [[nodiscard]] bool is_good() const { return faults.empty(); }
  /// Half of the longest axis of the 95 % ellipsoid of the camera's position (m) and rotation
  /// (rad).
  [[nodiscard]] double position_error() const;
  [[nodiscard]] double rotation_error() const;
};

/// Estimates a camera's pose from the robot that it sees: in depth images, or in masks alone. The
/// camera is fixed to the root or to any link of the robot. Where no frame has depth, the masks
/// alone are fitted. Throws InputError for fewer frames than KeptFrames::least, frames without
/// images, images of another size than the camera's, and options that need depth; any other failure
/// is Calibration::faults.
[[nodiscard]] Calibration calibrate(std::span<const KeptFrame> frames, const Intrinsics& camera,
                                    const Robot& robot, const CalibrationOptions& options);

}  // namespace penumbra
