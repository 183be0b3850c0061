// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/calibration/kept_frames.hpp>
#include <penumbra/camera/camera.hpp>
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
  std::size_t poses = 0;      ///< of the robot that were compared; fewer than 3 tell little
};

[[nodiscard]] std::string_view to_string(Diagnosis::Cause cause);

/// Keeps a few frames of a sequence, between which the robot moves, and diagnoses the setup.
class SetupCheck {
 public:
  static constexpr std::size_t most = 12;           ///< frames that are kept
  static constexpr std::size_t most_by_color = 20;  ///< the same of Images::color

  /// Frames from one colour image of a stream to the next: enough.
  static constexpr std::size_t color_step = 8;
  static constexpr int columns = 640;  ///< of images; finer ones find no more mistakes
  /// What frames are compared by.
  enum class Images : std::uint8_t {
    depth,
    color,  ///< of a camera without depth, which stands still
    scans   ///< of a sensor of points, drawn as depth images
  };

  /// `camera`: of the reports' images, of Images::color that of the colour images; `camera_parent`:
  /// index of the link that carries it.
  SetupCheck(const Robot& robot, const Camera& camera, std::size_t camera_parent,
             Images images = Images::depth);

  /// Adds a frame in which the robot's pose and depth, or `color`, are known; ignores others.
  /// `joints`: its positions in the order of Robot::variables(); empty if the poses are from TF.
  /// Copies the images of few frames only, once `draw` has made them; null: they are there.
  void add(const FrameReport& report, std::span<const double> joints,
           const std::function<void()>& draw = nullptr, const ImageView<const Rgb8>& color = {});

  /// Compares the setup with what it would be if one mistake was mended. Takes a tenth of a second
  /// if nothing looks wrong, else about a second; by colours some seconds.
  [[nodiscard]] Diagnosis diagnose() const;

  /// Returns the number of kept frames. The robot's pose differs in all of them.
  [[nodiscard]] std::size_t poses() const { return kept_.frames().size(); }
  /// Returns a line for each link that carries something large that the URDF lacks. `fringe_reach`:
  /// of the label rule, pixels of the reports' images.
  [[nodiscard]] std::vector<std::string> missing_parts(int fringe_reach) const;

 private:
  Robot robot_;
  std::size_t parent_;
  Images images_;
  KeptFrames kept_;
  std::size_t pixels_ = 0, measured_ = 0, elsewhere_ = 0;  // all, and the robot's
};

/// Diagnoses a setup from frames of a pinhole camera, all of which have depth, or masks, or colour
/// images of a camera that stands still. If nothing about them is suspicious, only small errors of
/// the camera's pose are looked for. `raw_camera`: as it is given, if `camera`, of the frames, is
/// without its lens or smaller. `is_scanner`: of Images::scans.
[[nodiscard]] Diagnosis diagnose(std::span<const KeptFrame> frames, const Intrinsics& camera,
                                 const Intrinsics& raw_camera, const Robot& robot,
                                 std::size_t camera_parent,
                                 const Eigen::Isometry3d& T_parent_camera,
                                 bool is_suspicious = true, bool is_scanner = false);

}  // namespace penumbra
