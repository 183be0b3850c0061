// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/without_robot.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// The messages that ROS topics get of a judged frame: in the camera's frame, with the image's
/// stamp. A pixel is trusted if it is clear or front. If a link is not drawn, no pixel is trusted,
/// because the link may be anywhere.
class ResultMessages {
 public:
  /// `camera`: the camera of the judged raw images. Throws InputError as CloudMaker.
  explicit ResultMessages(const Camera& camera, const PointsRule& points = {});

  /// Takes a frame. The messages refer to this and are valid until the next call.
  void set(const FrameReport& report);

  /// Returns 32FC1, metres, 0: no robot; nothing if there is no virtual depth, for example because
  /// the robot's pose is unknown.
  [[nodiscard]] std::optional<ImageMessage> virtual_depth() const;
  /// Returns 8UC1, values of Label.
  [[nodiscard]] ImageMessage labels() const;
  /// Returns mono8: 255 where depth must not be trusted, else 0.
  [[nodiscard]] ImageMessage mask() const;
  /// Returns mono8: 255 where the robot is drawn, else 0; nothing without virtual depth.
  [[nodiscard]] std::optional<ImageMessage> robot_mask();
  /// Returns the depth image without untrusted pixels: 0 in 16UC1, NaN in 32FC1.
  [[nodiscard]] ImageMessage filtered_depth() const;
  /// Returns the points of filtered_depth(), x y z in metres, as CloudMaker.
  [[nodiscard]] PointCloud2Message points();

  [[nodiscard]] const MessageHeader& header() const { return header_; }

 private:
  CloudMaker cloud_maker_;
  MessageHeader header_;
  Image<float> virtual_depth_;
  bool has_virtual_depth_ = false;
  Image<std::uint8_t> labels_, mask_, robot_mask_;
  DepthImage filtered_;
  PointCloud points_;
};

}  // namespace penumbra::io
