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

/// What is told of a frame on ROS's topics: in the camera's frame, with the image's stamp. A pixel
/// is trusted if it is clear or front, and none where a link is not drawn: it may stand anywhere.
class ResultMessages {
 public:
  /// `camera`: of the judged images as they come.
  explicit ResultMessages(const Camera& camera);

  /// Takes a frame; the messages refer to this until the next call.
  void set(const FrameReport& report);

  /// 32FC1, metres, 0: no robot; nothing where the robot's pose is unknown, or there is no virtual
  /// depth.
  [[nodiscard]] std::optional<ImageMessage> virtual_depth() const;
  /// 8UC1, values of Label.
  [[nodiscard]] ImageMessage labels() const;
  /// mono8: 255 where depth must not be trusted, else 0.
  [[nodiscard]] ImageMessage mask() const;
  /// The depth image without what is not trusted: 0 of 16UC1, NaN of 32FC1.
  [[nodiscard]] ImageMessage filtered_depth() const;
  /// Its points, x y z in metres. None where the lens model does not reach.
  [[nodiscard]] PointCloud2Message points();

  [[nodiscard]] const MessageHeader& header() const { return header_; }

 private:
  CloudMaker cloud_maker_;
  MessageHeader header_;
  Image<float> virtual_depth_;
  bool has_virtual_depth_ = false;
  Image<std::uint8_t> labels_, mask_;
  DepthImage filtered_;
  PointCloud points_;
};

}  // namespace penumbra::io
