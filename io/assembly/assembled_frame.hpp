// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/targets/target.hpp>
#include <penumbra/time/transform_buffer.hpp>

#include <io/assembly/camera_mount.hpp>
#include <io/assembly/color_images.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/ros/target_inbox.hpp>

namespace penumbra::io {

/// The robot, camera and mount that a camera's images are judged with, and the images that wait for
/// their pose. Another robot, camera_info or mount gives another setup. Constant members may be
/// read at any time; see FrameAssembler for the others.
struct CameraSetup {
  CameraSetup(std::shared_ptr<PosedRobot> of, JudgedCameras cameras_, CameraMount where,
              const FrameQueueOptions& options, HiddenTargets hidden, FrameQueue::OnDrop on_drop,
              FrameQueue::Check check)
      : posed(std::move(of)),
        cameras(std::move(cameras_)),
        mount(std::move(where)),
        queue(posed->robot, posed->history, options, std::move(on_drop), std::move(check)),
        targets(posed->robot, cameras.judged.frame_id, options.poses.frame_prefix, hidden) {}

  const std::shared_ptr<PosedRobot> posed;
  const JudgedCameras cameras;
  const CameraMount mount;
  FrameQueue queue;
  TargetInbox targets;
};

/// A frame whose images are not decoded yet: DepthInput does that. Its index counts the camera's
/// depth messages from 0. A source_message says why the image must not be used.
struct AssembledFrame : Frame {
  std::shared_ptr<CameraSetup> setup;
  KeptImage image;
  std::optional<KeptImage> color_image;  ///< if it was requested and received
  std::int64_t arrived = 0;              ///< on the caller's clock
  TransformAnswer T_judged_depth;        ///< if the setup has a separate depth camera
};

}  // namespace penumbra::io
