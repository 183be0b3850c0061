// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include <penumbra/cloud/scan.hpp>
#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/time/transform_buffer.hpp>

#include <io/assembly/camera_mount.hpp>
#include <io/assembly/color_images.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/ros/target_inbox.hpp>

namespace penumbra::io {

/// The robot and the sensor that frames are judged with, and the frames that wait for their pose.
/// Another robot, camera_info, frame or mount gives another setup. Constant members may be read at
/// any time; see FrameAssembler for the others.
struct SensorSetup {
  using Sensor = std::variant<JudgedCameras, CloudConfig>;

  SensorSetup(std::shared_ptr<PosedRobot> of, Sensor with, CameraMount on, std::string of_frame,
              const FrameQueueOptions& options, HiddenTargets hidden, FrameQueue::OnDrop on_drop,
              FrameQueue::Check check)
      : posed(std::move(of)),
        sensor(std::move(with)),
        mount(std::move(on)),
        frame(std::move(of_frame)),
        queue(posed->robot, posed->history, options, std::move(on_drop), std::move(check)),
        targets(posed->robot, frame, options.poses.frame_prefix, hidden) {}

  /// Return null for the other kind of sensor.
  [[nodiscard]] const JudgedCameras* cameras() const { return std::get_if<JudgedCameras>(&sensor); }
  [[nodiscard]] const CloudConfig* cloud() const { return std::get_if<CloudConfig>(&sensor); }

  const std::shared_ptr<PosedRobot> posed;
  const Sensor sensor;
  const CameraMount mount;
  const std::string frame;  ///< of the judged images or the clouds
  FrameQueue queue;
  TargetInbox targets;
};

/// Returns whether the robot's pose is known, also if the camera's is not.
[[nodiscard]] inline bool knows_robot(const RobotPose& pose) {
  return has_pose(pose.status) || !pose.positions.empty() || !pose.T_root_link.empty();
}

/// A frame of messages, whose index counts the sensor's messages from 0. Images are not decoded
/// yet: DepthInput does that. A source_message says why the frame must not be used.
struct AssembledFrame : Frame {
  std::shared_ptr<SensorSetup> setup;
  std::int64_t arrived = 0;  ///< on the caller's clock
  // Of a camera, whose image is not decoded yet:
  KeptImage image;
  std::optional<KeptImage> color_image;  ///< if it was requested and received
  TransformAnswer T_judged_depth;        ///< if the setup has a separate depth camera
};

}  // namespace penumbra::io
