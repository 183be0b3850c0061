// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <io/web/packet.hpp>

namespace penumbra::io {

/// Draws where a camera sees the robot's outline from its pose in use, and from the pose that its
/// calibration found. Thread-safe.
class PoseOutlines {
 public:
  PoseOutlines(const Robot& robot, const Camera& camera) : robot_(robot), camera_(camera) {}

  /// Returns Part::outlines, an image of bytes: 1 the pose in use, 2 the found one, 0 else. Returns
  /// nothing before a good pose is found, and if the robot's pose is unknown.
  [[nodiscard]] std::optional<PartBytes> draw(const RobotPose& pose, const CalibrationProgress& of);

 private:
  Robot robot_;
  std::mutex mutex_;
  Camera camera_;                     // guarded by mutex_
  std::optional<Pipeline> pipeline_;  // likewise; of the camera
};

}  // namespace penumbra::io
