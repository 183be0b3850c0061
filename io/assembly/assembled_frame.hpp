// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <penumbra/cloud/scan.hpp>
#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/time/transform_buffer.hpp>

#include <io/assembly/camera_mount.hpp>
#include <io/assembly/color_images.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/cloud/cloud_points.hpp>
#include <io/ros/target_inbox.hpp>

namespace penumbra::io {

/// What judges a sensor's frames.
struct JudgedSensor {
  std::optional<JudgedCameras> cameras = {};
  std::optional<CloudConfig> cloud = {};  ///< of a sensor of points, in place of cameras
  std::string frame = {};                 ///< of the judged images or the clouds
  CameraMount mount = {};
};

/// The robot and the sensor that frames are judged with, and the frames that wait for their pose.
/// Another robot, camera_info, frame or mount gives another setup. Constant members may be read at
/// any time; see FrameAssembler for the others.
struct SensorSetup {
  SensorSetup(std::shared_ptr<PosedRobot> of, JudgedSensor sensor_,
              const FrameQueueOptions& options, HiddenTargets hidden, FrameQueue::OnDrop on_drop,
              FrameQueue::Check check)
      : posed(std::move(of)),
        sensor(std::move(sensor_)),
        queue(posed->robot, posed->history, options, std::move(on_drop), std::move(check)),
        targets(posed->robot, sensor.frame, options.poses.frame_prefix, hidden) {}

  const std::shared_ptr<PosedRobot> posed;
  const JudgedSensor sensor;
  FrameQueue queue;
  TargetInbox targets;
};

using CloudMessage = std::variant<PointCloud2Message, LaserScanMessage, LivoxMessage>;

/// Returns whether the robot's pose is known, also if the camera's is not.
[[nodiscard]] inline bool knows_robot(const RobotPose& pose) {
  return has_pose(pose.status) || !pose.positions.empty() || !pose.T_root_link.empty();
}

/// A frame of messages, whose index counts the sensor's messages from 0. Images are not decoded
/// yet: DepthInput does that. A source_message says why the frame must not be used.
struct AssembledFrame : Frame {
  std::shared_ptr<SensorSetup> setup;
  std::int64_t arrived = 0;  ///< on the caller's clock
  // Of a camera:
  KeptImage image;
  std::optional<KeptImage> color_image;  ///< if it was requested and received
  TransformAnswer T_judged_depth;        ///< if the setup has a separate depth camera
  // Of a sensor of points:
  CloudMessage message;
  std::shared_ptr<const void> owner;  ///< of the bytes that the message refers to
  CloudPoints points;                 ///< of the scan
  std::string frame_id;
};

}  // namespace penumbra::io
