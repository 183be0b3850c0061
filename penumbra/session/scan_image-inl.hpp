// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/cloud/scan.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Draws scans as depth images of a camera at the sensor's origin that looks at the robot, for what
/// compares images. A pixel without a point is 0: not measured.
class ScanImage {
 public:
  ScanImage(const Robot& robot, const CloudConfig& config);
  virtual ~ScanImage() = default;

  // Virtual, so that a program without scans is linked without them.

  /// Takes a labelled scan, of which it reports the robot's pose: of one during which the robot
  /// moved, where most points show it. Returns false if no point is in the robot's direction, or
  /// there are no rays.
  virtual bool take(const FrameReport& of, const Frame& frame);
  /// Draws the scan, while it is valid: what was measured while the robot was nearly where it is
  /// in the report. Before that, the images are of the scan that was drawn last.
  virtual void draw();

  // Of what was drawn last; numbers and labels are the scan's:
  [[nodiscard]] const FrameReport& report() const { return report_; }
  [[nodiscard]] std::span<const double> positions() const { return pose_.positions; }
  /// Stays as the first scan makes it, and so does its pose on the sensor.
  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] std::size_t parent() const { return parent_; }

 private:
  bool place(const FrameReport& of, const Frame& frame);
  [[nodiscard]] Eigen::Isometry3d T_camera_sensor() const;
  void look(const FrameReport& of);
  void set_width(int width);
  [[nodiscard]] double measured_share() const;
  void fill();

  Robot robot_;
  std::size_t parent_;  // index of the link that carries the sensor
  PoseStage poses_;
  RobotPose pose_;
  const PoseResult* placed_ = nullptr;
  Scan scan_;
  bool is_drawn_ = false;
  std::int64_t begin_ = 0, end_ = 0;  // nanoseconds after the stamp: of what is drawn
  Eigen::Matrix3d R_camera_sensor_;
  double half_angle_ = 0.0;
  Camera camera_{Intrinsics(1, 1, 1.0, 1.0, 0.0, 0.0), {}, {}, {}};
  std::unique_ptr<DepthRenderer> renderer_;  // null before the first scan
  std::vector<Eigen::Isometry3d> T_camera_link_;
  Image<float> depth_;
  FrameReport report_;
};

}  // namespace penumbra
