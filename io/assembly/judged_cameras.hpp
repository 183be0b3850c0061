// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <penumbra/camera/camera.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// A camera_info and the topic of its images.
struct InfoOfImages {
  const CameraInfoMessage& info;
  std::string info_topic, image_topic;
};

/// The input of judged_cameras.
struct CameraEvidence {
  std::string source;  ///< the name of the bag for messages; may be empty
  InfoOfImages depth;
  std::optional<InfoOfImages> color;  ///< if depth is judged in the color image
  std::string depth_frame;            ///< frame_id of the depth images
  bool info_is_named = false;         ///< the user named this camera_info topic
  bool is_rectified = false;          ///< the user set that all images have no distortion
};

/// The camera of the judged images, and that of the depth images if it differs.
struct JudgedCameras {
  Camera judged;  ///< of a SensorSetup, with the pose of its mount
  std::optional<Camera> depth;
  CameraInfoMessage info = {};             ///< of `judged`, as received
  bool has_depth = true;                   ///< false: the images are colour images
  std::optional<double> depth_scale = {};  ///< metres per unit; default: as shared_depth_of()
  bool depth_along_ray = false;            ///< depth is the distance along each pixel's ray
};

/// Returns the cameras. Throws InputError that names the topic if camera_of refuses it, or if a
/// camera_info has another frame than the images.
[[nodiscard]] JudgedCameras judged_cameras(const CameraEvidence& evidence);

/// Returns whether two messages describe the same camera: all fields except the stamp are equal.
[[nodiscard]] bool is_same_camera(const CameraInfoMessage& a, const CameraInfoMessage& b);

/// Returns whether a topic name says that its images have no lens distortion: its last part begins
/// with "image_rect".
[[nodiscard]] bool is_called_rectified(const std::string& topic);

/// Returns a topic name without the suffix of image_transport: "/a/image" for
/// "/a/image/compressed".
[[nodiscard]] std::string image_base(const std::string& topic);

}  // namespace penumbra::io
