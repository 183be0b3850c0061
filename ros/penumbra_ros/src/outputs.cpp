// SPDX-License-Identifier: Apache-2.0
#include "outputs.hpp"

#include "markers.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <rclcpp/version.h>

#include <io/ros/message_encoder.hpp>

namespace penumbra_ros {
namespace {

using penumbra::io::Result;

constexpr std::size_t points_depth = 5;  // megabytes each

/// The end of compressed_image_transport's parameter.
#if RCLCPP_VERSION_GTE(21, 0, 0)  // Iron
constexpr const char* format_parameter = ".compressed.format";
#else
constexpr const char* format_parameter = ".format";
#endif

template <typename M>
auto advertise(rclcpp_lifecycle::LifecycleNode& node, const std::string& name,
               std::size_t depth = result_depth) {
  return rclcpp::create_publisher<M>(node, name, rclcpp::QoS(depth), with_qos_parameters());
}

}  // namespace

rclcpp::SerializedMessage message_of(std::span<const std::byte> payload) {
  rclcpp::SerializedMessage bytes(payload.size());
  rcl_serialized_message_t& rcl = bytes.get_rcl_serialized_message();
  std::memcpy(rcl.buffer, payload.data(), payload.size());
  rcl.buffer_length = payload.size();
  return bytes;
}

rclcpp::PublisherOptions with_qos_parameters() {
  rclcpp::PublisherOptions options;
  options.qos_overriding_options = rclcpp::QosOverridingOptions::with_default_policies();
  return options;
}

Outputs::Outputs(rclcpp_lifecycle::LifecycleNode& node, rclcpp::Node& images,
                 const std::string& below, bool target_frames, std::string frame_prefix)
    : frame_prefix_(std::move(frame_prefix)),
      look_ahead_(node, below + "look_ahead"),
      points_(advertise<sensor_msgs::msg::PointCloud2>(node, below + "points", points_depth)),
      targets_(advertise<penumbra_msgs::msg::Targets>(node, below + "targets")),
      overlay_(advertise<sensor_msgs::msg::CompressedImage>(node, below + "overlay/compressed")),
      camera_info_(advertise<sensor_msgs::msg::CameraInfo>(node, below + "camera_info")),
      markers_(advertise<visualization_msgs::msg::MarkerArray>(node, below + "markers")),
      detections_(advertise<vision_msgs::msg::Detection3DArray>(node, below + "detections")) {
  for (const Result result : {Result::virtual_depth, Result::labels, Result::mask,
                              Result::filtered_depth, Result::robot_mask}) {
    const std::string topic = node.get_node_topics_interface()->resolve_topic_name(
        below + output_names[static_cast<std::size_t>(result)]);
    // JPEG, compressed_image_transport's default, would change labels and masks.
    std::string parameters = topic.substr(images.get_effective_namespace().size());
    std::replace(parameters.begin(), parameters.end(), '/', '.');
    images.declare_parameter(parameters + format_parameter, "png");
    images_[result] = image_transport::create_publisher(
        &images, topic, rclcpp::QoS(result_depth).get_rmw_qos_profile(), with_qos_parameters());
  }
  if (target_frames) frames_ = std::make_unique<tf2_ros::TransformBroadcaster>(node);
}

void Outputs::select(const std::set<std::string>& names) {
  for (std::size_t i = 0; i < output_names.size(); ++i)
    selected_[i] = names.count(output_names[i]) > 0;
}

bool Outputs::is_selected(const char* name) const {
  const auto found = std::find_if(output_names.begin(), output_names.end(),
                                  [&](const char* one) { return std::string_view(one) == name; });
  return selected_[static_cast<std::size_t>(found - output_names.begin())];
}

bool Outputs::wants(Result result) const {
  if (!selected_[static_cast<std::size_t>(result)]) return false;
  if (result == Result::points) return points_->get_subscription_count() > 0;
  if (result == Result::targets) return targets_->get_subscription_count() > 0;
  if (result == Result::overlay) return overlay_->get_subscription_count() > 0;
  return images_.at(result).getNumSubscribers() > 0;
}

void Outputs::write(Result result, std::int64_t /*stamp*/, std::span<const std::byte> payload) {
  if (result == Result::points)
    points_->publish(deserialised<sensor_msgs::msg::PointCloud2>(payload));
  else if (result == Result::targets)
    targets_->publish(deserialised<penumbra_msgs::msg::Targets>(payload));
  else if (result == Result::overlay)
    overlay_->publish(deserialised<sensor_msgs::msg::CompressedImage>(payload));
  else
    images_.at(result).publish(deserialised<sensor_msgs::msg::Image>(payload));
}

void Outputs::take(const penumbra::io::AssembledFrame& job, const penumbra::FrameReport& report,
                   const penumbra::Drift& /*drift*/) {
  if (is_selected("camera_info") && camera_info_->get_subscription_count() > 0)
    publish_camera_info(job.setup->cameras()->info, *report.stamp);
  if (is_selected("markers")) publish_markers(job, report);
  publish_detections(job, report);
  look_ahead_.take(job);
}

void Outputs::publish_camera_info(const penumbra::io::CameraInfoMessage& info, std::int64_t stamp) {
  penumbra::io::encode(info, payload_);
  auto message = deserialised<sensor_msgs::msg::CameraInfo>(payload_);
  message->header.stamp = rclcpp::Time(stamp);
  camera_info_->publish(std::move(message));
}

void Outputs::publish_markers(const penumbra::io::AssembledFrame& job,
                              const penumbra::FrameReport& report) {
  const std::size_t viewers = markers_->get_subscription_count();
  const bool has_new_viewer = viewers > std::exchange(viewers_, viewers);
  if (viewers == 0) return;
  if (has_new_viewer || shown_ != job.setup)
    markers_->publish(link_markers(job.setup->posed->robot, frame_prefix_));
  shown_ = job.setup;
  if (auto markers = target_markers(report, frame_prefix_); !markers->markers.empty())
    markers_->publish(std::move(markers));
}

void Outputs::publish_detections(const penumbra::io::AssembledFrame& job,
                                 const penumbra::FrameReport& report) {
  const bool has_listener = is_selected("detections") && detections_->get_subscription_count() > 0;
  if (!has_listener && !frames_) return;
  auto detections = handled_detections(report, job.targets, frame_prefix_);
  if (frames_) frames_->sendTransform(frames_of(*detections));
  if (has_listener) detections_->publish(std::move(detections));
}

void CloudOutputs::set_cloud_type(const std::string& type) {
  const auto publish = [&](Result result, const std::string& topic, const std::string& of) {
    if (!publishers_[result])
      publishers_[result] = node_.create_generic_publisher(topic, of, rclcpp::QoS(points_depth));
  };
  publish(Result::without_robot, topic_, type);
  if (type == penumbra::io::message_type<penumbra::io::PointCloud2Message>())
    publish(Result::labelled, topic_ + "/labelled", type);
  publish(Result::targets, topic_ + "/targets",
          penumbra::io::message_type<penumbra::io::TargetsMessage>());
}

bool CloudOutputs::wants(Result result) const {
  const auto found = publishers_.find(result);
  return found != publishers_.end() && found->second->get_subscription_count() > 0;
}

void CloudOutputs::write(Result result, std::int64_t /*stamp*/,
                         std::span<const std::byte> payload) {
  publishers_.at(result)->publish(message_of(payload));
}

}  // namespace penumbra_ros
