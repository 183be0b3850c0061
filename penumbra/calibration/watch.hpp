// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

/// Beyond which a camera's motion is reported.
struct DriftLimits {
  double position = 0.002;                           ///< metres, > 0
  double rotation = 0.1 * std::numbers::pi / 180.0;  ///< rad, > 0

  /// Throws InputError for limits that are not positive.
  void check() const;
};

/// How far a camera is from its calibration.
struct Drift {
  bool is_camera = true;  ///< false: a sensor of points
  bool is_known = false;  ///< the robot has been seen in enough poses
  /// The camera's pose in its calibrated frame.
  Eigen::Isometry3d T_calibrated_camera = Eigen::Isometry3d::Identity();
  PoseCovariance covariance = PoseCovariance::Zero();
  Estimate time_offset;  ///< seconds to add to an image's stamp before poses are looked up

  bool has_moved = false;      ///< farther than the limits; neither chance nor clocks explain it
  bool clocks_differ = false;  ///< by more than 5 ms; neither chance nor the pose explains it
  /// One of the two, and the robot's motion does not tell which: then the pose is as if the clocks
  /// were right, and the time offset as if the pose were.
  bool camera_or_clocks = false;

  /// Index and stamp (ns) of the frame at which the camera moved suddenly; null if it did not, or
  /// if the frame is not known within 30 frames.
  std::optional<std::size_t> bumped_at;
  std::optional<std::int64_t> bumped_at_stamp;
  std::size_t bumped_within = 0;  ///< frames by which that may be off
  /// Share of the robot's pixels in which the sensor sees past its surface; about 1 if the robot is
  /// elsewhere by more than its size.
  double seen_through = 0.0;

  /// Metres and rad, and half of the longest axis of their 95 % ellipsoids.
  [[nodiscard]] double position() const { return T_calibrated_camera.translation().norm(); }
  [[nodiscard]] double rotation() const;
  [[nodiscard]] double position_error() const;
  [[nodiscard]] double rotation_error() const;
  /// One line for users if the camera has moved or clocks differ; else empty.
  [[nodiscard]] std::string message() const;
};

/// Watches whether a camera stays where its calibration says, from the depth of the robot that it
/// sees. It never changes the calibration. Costs about 20 us per frame.
class CalibrationWatch {
 public:
  /// `camera`: of the reports' images; `is_camera`: else they are drawn from a sensor's scans.
  /// Throws InputError as DriftLimits::check().
  explicit CalibrationWatch(const Camera& camera, const DriftLimits& limits = {},
                            bool is_camera = true);
  ~CalibrationWatch();
  CalibrationWatch(CalibrationWatch&&) noexcept;
  CalibrationWatch& operator=(CalibrationWatch&&) noexcept;

  /// Adds a frame in which the robot's pose and depth are known; ignores others.
  void add(const FrameReport& report);
  [[nodiscard]] const Drift& drift() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
