// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// The robot's poses before or after an image.
struct NearbyPoses {
  double seconds = 0.0;  ///< after the image
  std::vector<Eigen::Isometry3d> T_root_link;
};

/// The links' poses in the root at stamps (ns), in any order.
using StampedPoses = std::vector<std::pair<std::int64_t, std::vector<Eigen::Isometry3d>>>;

/// Returns the poses up to 0.15 s before and after an image's stamp; none if they reach less than
/// 0.1 s.
[[nodiscard]] std::vector<NearbyPoses> nearby_poses(const StampedPoses& trajectory,
                                                    std::int64_t stamp);

/// What calibration needs of a frame.
struct CalibrationFrame {
  std::size_t index = 0;
  /// Measured by a pinhole camera, metres; 0: no measurement. Empty in all frames: the masks alone
  /// are fitted.
  Image<float> depth;
  Image<std::uint8_t> mask;    ///< not 0 where the colour image shows the robot; empty: not known
  std::vector<double> joints;  ///< order of Robot::variables(); empty if the poses are from TF
  std::vector<Eigen::Isometry3d> T_root_link;
  /// In time's order, this frame's own among them; empty: not known. Tells whether the poses are of
  /// another time, and is needed for CalibrationOptions::time_offset.
  std::vector<NearbyPoses> nearby;
};

struct CalibrationOptions {
  std::string camera_parent;  ///< link that carries the camera; empty: the root
  /// The camera's pose in that link, at most 100 mm and 10 degrees off; null: it is searched for.
  std::optional<Eigen::Isometry3d> initial;
  bool focal = false;  ///< estimate the focal lengths, too
  /// Estimate the zero offsets of joints that the images contradict; needs depth.
  bool joint_offsets = false;
  bool time_offset = false;  ///< estimate the time between images and poses, too; needs depth
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
  std::size_t index = 0;  ///< CalibrationFrame::index
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

/// Chooses frames of an input between which the robot moves: those in which it stands still before
/// the others, or moving ones alone, for CalibrationOptions::time_offset.
class CalibrationFrames {
 public:
  static constexpr std::size_t least = 3;
  static constexpr std::size_t most = 20;
  static constexpr double least_motion = 0.03;  ///< metres that one link moves, at least

  /// `needs_depth`: frames without a depth image are not used.
  CalibrationFrames(const Robot& robot, bool needs_depth, bool moving = false)
      : robot_(robot), needs_depth_(needs_depth), moving_(moving) {}

  /// Looks at the next frame of the input. If it is wanted, returns it without its images: call
  /// add() with them. The poses of other frames, also of those without an image, tell the time
  /// offset. Throws InputError if the camera moves on its link, and for moving frames without a
  /// stamp.
  [[nodiscard]] std::optional<CalibrationFrame> pass(const Frame& frame);
  /// Keeps the frame of the last pass(); thins out when there are too many.
  void add(CalibrationFrame frame);

  /// Returns the chosen frames, with the poses around those of a moving robot.
  [[nodiscard]] std::vector<CalibrationFrame> chosen() const;
  /// Returns the camera's pose in its link as the frames have it; null: they have none.
  [[nodiscard]] const std::optional<Eigen::Isometry3d>& T_parent_camera() const {
    return T_parent_camera_;
  }
  [[nodiscard]] std::size_t seen() const { return seen_; }
  /// Returns which frames cannot be used and whether too few are at rest, a line each.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Kept {
    double motion = least_motion;
    std::vector<CalibrationFrame> frames = {};
    [[nodiscard]] bool wants(std::span<const Eigen::Isometry3d> T_root_link) const;
    void add(CalibrationFrame frame);
  };
  [[nodiscard]] bool has_rested() const { return !moving_ && resting_.frames.size() >= least; }
  [[nodiscard]] bool is_posed(const RobotPose& pose) const;
  void follow(const CalibrationFrame& frame, std::optional<std::int64_t> stamp);
  void follow_camera(const CalibrationFrame& frame, const Eigen::Isometry3d& T_parent_camera);

  Robot robot_;
  bool needs_depth_, moving_;
  Kept resting_, all_;
  std::optional<std::int64_t> stamp_;  // of the last frame with a pose
  std::vector<Eigen::Isometry3d> T_root_link_;
  std::optional<double> speed_;  // since the one before, of the fastest link's origin, m/s
  StampedPoses trajectory_;
  std::map<std::size_t, std::int64_t> stamps_;  // of kept frames
  std::optional<Eigen::Isometry3d> T_parent_camera_;
  std::size_t seen_ = 0, faulty_ = 0;
  std::string fault_;  // of the first
};

/// Estimates a camera's pose from the robot that it sees: in depth images, or in masks alone. The
/// camera is fixed to the root or to any link of the robot. Throws InputError for fewer frames than
/// CalibrationFrames::least, frames without images, images of another size than the camera's, and
/// options that need depth; any other failure is Calibration::faults.
[[nodiscard]] Calibration calibrate(std::span<const CalibrationFrame> frames,
                                    const Intrinsics& camera, const Robot& robot,
                                    const CalibrationOptions& options);

}  // namespace penumbra
