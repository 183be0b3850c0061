// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/time/transform_buffer.hpp>

#include <io/assembly/camera_mount.hpp>
#include <io/assembly/color_images.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/files/report_json.hpp>
#include <io/live/live_robot.hpp>
#include <io/ros/target_inbox.hpp>

namespace penumbra::io {

/// The robot, camera and mount that a camera's images are judged with, and the images that wait.
/// Another robot, camera_info or mount gives another setup. Constant members may be read at any
/// time; see LiveInbox for the others.
struct LiveSetup {
  LiveSetup(std::shared_ptr<PosedRobot> of, JudgedCameras cameras_, CameraMount where,
            const FrameQueueOptions& options, FrameQueue::OnDrop on_drop)
      : posed(std::move(of)),
        cameras(std::move(cameras_)),
        mount(std::move(where)),
        queue(posed->robot, posed->history, options, std::move(on_drop)),
        targets(posed->robot, cameras.judged.frame_id, options.poses.frame_prefix) {}

  const std::shared_ptr<PosedRobot> posed;
  const JudgedCameras cameras;
  const CameraMount mount;
  FrameQueue queue;
  TargetInbox targets;
};

/// A depth image to judge.
struct LiveJob {
  std::shared_ptr<LiveSetup> setup;
  KeptImage image;
  std::int64_t arrived = 0;  ///< on the caller's clock
  QueuedFrame pose;
  TransformAnswer T_judged_depth;   ///< if the setup has a separate depth camera
  std::span<const Target> targets;  ///< valid until the setup's next job
  bool with_overlay = true;         ///< false: no overlay is drawn even if a sink wants it
  std::optional<KeptImage> color;   ///< if it was requested and received
};

/// The outcome of a job.
struct LiveOutcome {
  bool is_published = false;
  std::string fault;  ///< why the image could not be judged; empty if it is published
  FrameStatus status = FrameStatus::ok;
  std::string message;               ///< one line; empty for the status ok
  std::size_t unjudged_targets = 0;  ///< targets of an image that could not be judged
  StageTimes timing;
  std::int64_t stamp = 0;
  std::int64_t arrived = 0;
  std::optional<RendererInfo> renderer;  ///< the renderer used; nothing if it could not be made
};

}  // namespace penumbra::io
