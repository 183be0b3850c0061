// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/cloud/cloud_points.hpp>
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

/// Encodes the results of a sensor's judged frames that a sink wants.
class ResultEncoder {
 public:
  /// Of images. `camera`: that of the judged images as received.
  ResultEncoder(const Robot& robot, const Camera& camera, const PointsRule& points = {})
      : root_(robot.links().front()),
        images_(std::in_place, camera, points),
        painter_(std::in_place, robot, camera, nullptr) {}
  /// Of scans.
  ResultEncoder(const Robot& robot, CloudOutput how) : root_(robot.links().front()), how_(how) {}

  /// Encodes and writes the results of a frame, except those `skipped`; of a cloud that was not
  /// read, its targets. The report of an image must have a stamp.
  void encode(const Frame& frame, const FrameReport& report, ResultSink& sink,
              std::span<const Result> skipped = {});

 private:
  void encode_images(const Frame& frame, const FrameReport& report, ResultSink& sink,
                     std::span<const Result> skipped);
  void encode_cloud(const Frame& frame, const FrameReport& report, ResultSink& sink);
  template <typename M>
  void write(Result result, std::int64_t stamp, const M& message, ResultSink& sink);

  std::string root_;
  std::optional<ResultMessages> images_;  // null: of scans
  std::optional<OverlayPainter> painter_;
  CloudOutput how_;
  bool has_type_ = false;  // of clouds
  std::vector<std::byte> data_, payload_;
};

}  // namespace penumbra::io
