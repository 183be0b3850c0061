// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/assembly/assembled_frame.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/ros/result_messages.hpp>

namespace penumbra::io {

/// The results that are published.
enum class Result {
  virtual_depth,
  labels,
  mask,
  filtered_depth,
  points,
  targets,
  overlay,
  robot_mask,
  // Of a sensor of points, like targets:
  without_robot,  ///< its clouds, of the input's type
  labelled        ///< with CloudOutput::labelled; of PointCloud2
};

struct ResultTopic {
  Result result;
  std::string_view name;  ///< follows "/penumbra/"
  std::string_view type;
};
inline constexpr std::array result_topics = {
    ResultTopic{Result::virtual_depth, "vdi", "sensor_msgs/msg/Image"},
    ResultTopic{Result::labels, "labels", "sensor_msgs/msg/Image"},
    ResultTopic{Result::mask, "mask", "sensor_msgs/msg/Image"},
    ResultTopic{Result::filtered_depth, "filtered_depth", "sensor_msgs/msg/Image"},
    ResultTopic{Result::points, "points", "sensor_msgs/msg/PointCloud2"},
    ResultTopic{Result::targets, "targets", "penumbra_msgs/msg/Targets"},
    ResultTopic{Result::overlay, "overlay/compressed", "sensor_msgs/msg/CompressedImage"},
    ResultTopic{Result::robot_mask, "robot_mask", "sensor_msgs/msg/Image"}};

/// Receives encoded results of a sensor: a bag or the graph of ROS 2.
class ResultSink {
 public:
  ResultSink() = default;
  ResultSink(const ResultSink&) = delete;
  ResultSink& operator=(const ResultSink&) = delete;
  virtual ~ResultSink() = default;

  /// Tells the message type of a sensor's clouds, before wants() is asked for the first one of a
  /// setup.
  virtual void set_cloud_type(const std::string& /*type*/) {}
  /// Returns whether to make this result.
  [[nodiscard]] virtual bool wants(Result result) const = 0;
  /// Writes a result. `payload`: the message in CDR, valid during the call.
  virtual void write(Result result, std::int64_t stamp, std::span<const std::byte> payload) = 0;
};

/// Encodes the results of labelled scans that a sink wants.
class CloudEncoder {
 public:
  /// `root`: the robot's root link.
  CloudEncoder(CloudOutput how, std::string root) : how_(how), root_(std::move(root)) {}

  /// Encodes and writes the results of a scan; of a cloud that was not read, its targets. `cloud`:
  /// its message, whose Frame part may have been moved away.
  void encode(const FrameReport& report, const Frame& frame, const AssembledFrame& cloud,
              ResultSink& sink);

 private:
  CloudOutput how_;
  std::string root_;
  bool has_type_ = false;
  std::vector<std::byte> data_, payload_;
};

/// Encodes the results of judged images that a sink wants.
class ResultEncoder {
 public:
  /// `camera`: of the judged images as received; `root`: the robot's root link.
  ResultEncoder(const Camera& camera, std::string root, const PointsRule& points = {})
      : results_(camera, points), root_(std::move(root)) {}

  /// Encodes and writes the results of a frame. The report must have a stamp. `images.depth`: the
  /// judged image.
  void encode(const FrameReport& report, const ShownImages& images, const ShownTargets& targets,
              ResultSink& sink);

 private:
  template <typename M>
  void write(Result result, const M& message, ResultSink& sink);

  ResultMessages results_;
  std::string root_;
  OverlayPainter painter_{nullptr};
  std::vector<std::byte> png_, payload_;
};

}  // namespace penumbra::io
