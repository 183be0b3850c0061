// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "look_ahead.hpp"

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>

#include <image_transport/image_transport.hpp>
#include <penumbra_msgs/msg/targets.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp/serialization.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/compressed_image.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <tf2_ros/transform_broadcaster.h>
#include <vision_msgs/msg/detection3_d_array.hpp>
#include <visualization_msgs/msg/marker_array.hpp>

#include <io/assembly/result_encoder.hpp>
#include <io/live/frame_watcher.hpp>
#include <io/live/live_runner.hpp>

namespace penumbra_ros {

/// Names of a camera's results: those of penumbra::io::Result in its order, then ours.
inline constexpr std::array<const char*, 11> output_names = {
    "virtual_depth", "labels",     "mask",        "filtered_depth", "points",    "targets",
    "overlay",       "robot_mask", "camera_info", "markers",        "detections"};

inline constexpr std::size_t result_depth = 10;

/// Options with which ROS's parameters override a publisher's QoS.
[[nodiscard]] rclcpp::PublisherOptions with_qos_parameters();

/// Returns a copy of a message in CDR.
[[nodiscard]] rclcpp::SerializedMessage message_of(std::span<const std::byte> payload);

template <typename M>
[[nodiscard]] std::unique_ptr<M> deserialised(std::span<const std::byte> payload) {
  const rclcpp::SerializedMessage bytes = message_of(payload);
  auto message = std::make_unique<M>();
  rclcpp::Serialization<M>().deserialize_message(&bytes, message.get());
  return message;
}

/// Publishes the results of a camera that have subscribers. The camera's thread calls wants(),
/// write() and take(); the other functions are for any thread.
class Outputs final : public penumbra::io::ResultSink, public penumbra::io::FrameWatcher {
 public:
  /// `images`: publishes those by image_transport, which takes no lifecycle node. `below`: of the
  /// topics, "~/" or "~/CAMERA/". `target_frames`: publishes targets in TF. `frame_prefix`: of link
  /// names in TF.
  Outputs(rclcpp_lifecycle::LifecycleNode& node, rclcpp::Node& images, const std::string& below,
          bool target_frames, std::string frame_prefix);

  /// Limits the results to these names.
  void select(const std::set<std::string>& names);
  /// The rule of the images from now on.
  void set_rule(const penumbra::LabelRule& rule) { look_ahead_.set_rule(rule); }

  [[nodiscard]] bool wants(penumbra::io::Result result) const override;
  void write(penumbra::io::Result result, std::int64_t stamp,
             std::span<const std::byte> payload) override;

  [[nodiscard]] bool wants_color() const override { return false; }
  void take(const penumbra::io::AssembledFrame& job, const penumbra::FrameReport& report,
            const penumbra::Drift& drift) override;

 private:
  [[nodiscard]] bool is_selected(const char* name) const;
  void publish_camera_info(const penumbra::io::CameraInfoMessage& info, std::int64_t stamp);
  void publish_markers(const penumbra::io::AssembledFrame& job,
                       const penumbra::FrameReport& report);
  void publish_detections(const penumbra::io::AssembledFrame& job,
                          const penumbra::FrameReport& report);

  std::string frame_prefix_;
  LookAheadService look_ahead_;
  std::array<std::atomic<bool>, output_names.size()> selected_ = {};
  std::map<penumbra::io::Result, image_transport::Publisher> images_;
  rclcpp::Publisher<sensor_msgs::msg::PointCloud2>::SharedPtr points_;
  rclcpp::Publisher<penumbra_msgs::msg::Targets>::SharedPtr targets_;
  rclcpp::Publisher<sensor_msgs::msg::CompressedImage>::SharedPtr overlay_;
  rclcpp::Publisher<sensor_msgs::msg::CameraInfo>::SharedPtr camera_info_;
  rclcpp::Publisher<visualization_msgs::msg::MarkerArray>::SharedPtr markers_;
  rclcpp::Publisher<vision_msgs::msg::Detection3DArray>::SharedPtr detections_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> frames_;  // null: no targets in TF
  std::vector<std::byte> payload_;
  std::shared_ptr<const penumbra::io::SensorSetup> shown_;  // whose robot the markers show
  std::size_t viewers_ = 0;                                 // of the markers
};

/// Publishes the clouds of a sensor that have subscribers, with the type of its messages.
class CloudOutputs final : public penumbra::io::ResultSink {
 public:
  /// `topic`: of the clouds; labelled ones are on "TOPIC/labelled", targets on "TOPIC/targets".
  CloudOutputs(rclcpp_lifecycle::LifecycleNode& node, std::string topic)
      : node_(node), topic_(std::move(topic)) {}

  void set_cloud_type(const std::string& type) override;
  [[nodiscard]] bool wants(penumbra::io::Result result) const override;
  void write(penumbra::io::Result result, std::int64_t stamp,
             std::span<const std::byte> payload) override;

 private:
  rclcpp_lifecycle::LifecycleNode& node_;
  std::string topic_;
  std::map<penumbra::io::Result, rclcpp::GenericPublisher::SharedPtr> publishers_;
};

}  // namespace penumbra_ros
