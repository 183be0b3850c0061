// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <penumbra/camera/camera.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// A camera_info and the images that it is of.
struct InfoOfImages {
  const CameraInfoMessage& info;
  std::string info_topic, image_topic;
};

/// What is known of a camera's images.
struct CameraEvidence {
  std::string source;  ///< the bag, for messages; empty: none
  InfoOfImages depth;
  std::optional<InfoOfImages> color;  ///< if results are to fit the color image
  std::string depth_frame;            ///< frame_id of the depth images
  bool info_is_named = false;         ///< the user says that this camera_info is theirs
  bool is_rectified = false;          ///< the user says that all images are free of distortion
};

/// The camera of the judged images, and the depth images' own if it is another.
struct JudgedCameras {
  Camera judged;
  std::optional<Camera> depth;
};

/// Throws InputError that names the topic, for what camera_of refuses and for a camera_info of
/// another frame than the images.
[[nodiscard]] JudgedCameras judged_cameras(const CameraEvidence& evidence);

/// Whether two messages are of the same camera: all but the stamp.
[[nodiscard]] bool is_same_camera(const CameraInfoMessage& a, const CameraInfoMessage& b);

/// Whether a topic is called as one of images without lens distortion is: its last part begins with
/// "image_rect".
[[nodiscard]] bool is_called_rectified(const std::string& topic);

/// A topic's name without what image_transport puts behind it: "/a/image" of "/a/image/compressed".
[[nodiscard]] std::string image_base(const std::string& topic);

}  // namespace penumbra::io
