// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

/// What is wrong with a setup: robot, joint positions, camera and its pose.
struct Diagnosis {
  enum class Cause : std::uint8_t {
    none,               ///< nothing that the frames show
    depth_unit,         ///< depth is in another unit
    depth_scale,        ///< depth is scaled by a factor that is no unit, as normalised depth is
    depth_ray,          ///< depth is the distance along the ray, not its z-component
    camera_unit,        ///< the camera's position is in millimetres
    camera_inverted,    ///< the camera's pose is the inverse
    camera_transposed,  ///< its rotation is transposed
    camera_axes,        ///< its axes are not those of the optical frame
    camera_pose,        ///< the camera is elsewhere
    intrinsics,         ///< camera_info is of another resolution or camera
    joint_unit,         ///< joint positions are in degrees
    joint_sign,         ///< a joint turns the other way
    joint_zero,         ///< a joint's zero is off
    joint_order,        ///< two joints are exchanged
    joint_time,         ///< joints and images are of different times
    unexplained         ///< the setup is wrong, and no single known mistake explains it
  };

  Cause cause = Cause::none;
  Cause other = Cause::none;  ///< a second cause that the frames cannot rule out
  std::string message;        ///< one line with the amount and the remedy; empty if there is none
  std::size_t frame = 0;      ///< index of the frame that shows it most
  double score = 0.0;         ///< agreement of the setup as given, at most 1
  double best = 0.0;          ///< the same after the mend
};

[[nodiscard]] std::string_view to_string(Diagnosis::Cause cause);

/// The robot in a frame near another one.
struct NearbyFrame {
  int frames = 0;                 ///< after the other one
  std::optional<double> seconds;  ///< after the other one
  std::vector<double> joints;     ///< order of Robot::variables(); empty if the poses are from TF
  std::vector<Eigen::Isometry3d> T_root_link;
};

/// What a diagnosis needs of a frame.
struct DiagnosisFrame : CalibrationFrame {
  std::vector<NearbyFrame> around;  ///< in order, this frame's own among them
};

/// Keeps a few frames of a sequence, between which the robot moves, and diagnoses the setup.
class SetupCheck {
 public:
  static constexpr std::size_t most = 12;  ///< frames that are kept
  static constexpr int reach = 7;          ///< frames before and after a kept one

  /// `camera`: of the reports' images; `camera_parent`: index of the link that carries it.
  /// `is_scanner`: they are drawn from a sensor's scans, and the camera is the sensor.
  SetupCheck(const Robot& robot, const Camera& camera, std::size_t camera_parent,
             bool is_scanner = false);

  /// Adds a frame in which the robot's pose and depth are known; ignores others. `joints`: its
  /// positions in the order of Robot::variables(); empty if the poses are from TF. Copies the depth
  /// image of few frames only.
  void add(const FrameReport& report, std::span<const double> joints);

  /// Compares the setup with what it would be if one mistake was mended. Takes a tenth of a second
  /// if nothing looks wrong, else about a second.
  [[nodiscard]] Diagnosis diagnose() const;

  /// Returns the number of kept frames. The robot's pose differs in all of them.
  [[nodiscard]] std::size_t poses() const { return frames_.size(); }

 private:
  struct Seen {
    std::size_t number;
    std::optional<std::int64_t> stamp;
    std::vector<double> joints;
    std::vector<Eigen::Isometry3d> T_root_link;
  };
  [[nodiscard]] bool wants(std::span<const Eigen::Isometry3d> T_root_link) const;
  void keep(const FrameReport& report);
  void thin_out();

  Robot robot_;
  std::size_t parent_;
  bool is_scanner_;
  std::optional<Rectification> lens_;
  int block_;
  Intrinsics camera_;  // of the kept images
  std::optional<Eigen::Isometry3d> T_parent_camera_;
  std::size_t pixels_ = 0, measured_ = 0, elsewhere_ = 0;  // all, and the robot's
  std::size_t seen_ = 0;
  double motion_ = CalibrationFrames::least_motion;
  std::deque<Seen> recent_;
  std::vector<DiagnosisFrame> frames_;
  std::vector<Seen> kept_;  // of frames_, without poses
};

/// Diagnoses a setup from frames of a pinhole camera. If nothing about them is suspicious, only
/// small errors of the camera's pose are looked for. `is_scanner`: as of SetupCheck.
[[nodiscard]] Diagnosis diagnose(std::span<const DiagnosisFrame> frames, const Intrinsics& camera,
                                 const Robot& robot, std::size_t camera_parent,
                                 const Eigen::Isometry3d& T_parent_camera,
                                 bool is_suspicious = true, bool is_scanner = false);

}  // namespace penumbra
