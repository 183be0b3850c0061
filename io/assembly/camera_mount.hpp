// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/robot/robot.hpp>
#include <penumbra/time/transform_buffer.hpp>

#include <io/assembly/bag_options.hpp>
#include <io/assembly/frame_tree.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// The user's options for the camera's pose.
struct MountOptions {
  std::optional<std::string> camera_frame = {};  ///< in place of the images' frame_id
  std::optional<std::string> parent = {};        ///< link
  std::optional<Eigen::Isometry3d> pose =
      {};                         ///< of the optical frame in the link, in place of TF's
  std::string pose_source = {};   ///< "--pose FILE"
  std::string frame_prefix = {};  ///< PoseOptions::frame_prefix
};

/// Returns the mount's part of these options. Throws InputError of the pose's file.
[[nodiscard]] MountOptions mount_options(const BagOptions& bag);

/// The pose of a camera on the robot.
struct CameraMount {
  std::string frame;   ///< of the judged images in TF; empty: T_parent_camera is the pose
  std::string parent;  ///< a link of the robot
  Eigen::Isometry3d T_parent_camera = Eigen::Isometry3d::Identity();
  std::string source;  ///< the source of the pose, for messages

  [[nodiscard]] bool operator==(const CameraMount& other) const {
    return frame == other.frame && parent == other.parent &&
           T_parent_camera.matrix() == other.T_parent_camera.matrix();
  }
};

/// Returns the mount by the options, the robot and TF: the nearest link above the camera's frame.
/// Returns nothing if no link is above it yet. Throws InputError for a parent that is not a link,
/// and for images that do not name their frame.
[[nodiscard]] std::optional<CameraMount> find_mount(const Robot& robot, const MountOptions& options,
                                                    const FrameTree& frames,
                                                    const std::string& frame_of_images);

/// Returns whether a frame is the root link's or above it in TF, as odom and map are: no sensor's.
[[nodiscard]] bool is_above_robot(const Robot& robot, const MountOptions& options,
                                  const FrameTree& frames, const std::string& frame);

/// Returns the frame that find_mount looks for in TF.
[[nodiscard]] std::string mounted_frame(const MountOptions& options,
                                        const std::string& frame_of_images);

/// Returns what TF has before the links' names, if that is not the options' prefix and a link is
/// above the frame with it; else an empty text.
[[nodiscard]] std::string likely_prefix(const Robot& robot, const FrameTree& frames,
                                        const std::string& frame);

/// Returns the transform of TF that gives a camera this mount: that of the camera's topmost frame,
/// whose driver publishes the frames below it. Returns nothing if the camera's frame is a link of
/// the robot: its URDF has the pose. `transforms`: with the camera's own.
[[nodiscard]] std::optional<TransformMessage> transform_of_mount(const Robot& robot,
                                                                 const TransformBuffer& transforms,
                                                                 const FrameTree& frames,
                                                                 const MountOptions& options,
                                                                 const CameraMount& mount);

/// Returns the mount of a camera that is not on the robot: TF must connect it to the root link.
[[nodiscard]] CameraMount mount_by_root(const Robot& robot, const MountOptions& options,
                                        const std::string& frame_of_images);

}  // namespace penumbra::io
