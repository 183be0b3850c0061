// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <rclcpp/rclcpp.hpp>
#include <rclcpp/version.h>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_msgs/msg/string.hpp>
#include <tf2_msgs/msg/tf_message.hpp>
#include <vision_msgs/msg/detection2_d_array.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

namespace penumbra_ros::test {

using sensor_msgs::msg::Image;

/// Publishes the frames of the shipped recording as a robot's and a camera's drivers do.
class Player {
 public:
  Player(const std::string& folder, bool intra_process)
      : node(std::make_shared<rclcpp::Node>(
            "player", rclcpp::NodeOptions().use_intra_process_comms(intra_process))),
        recording(penumbra::io::Recording::open(folder)),
        robot(recording.load_robot()),
        reader(recording, robot) {
    rclcpp::PublisherOptions latched_options;
#if !RCLCPP_VERSION_GTE(28, 0, 0)  // Jazzy; before, latched topics refuse it
    latched_options.use_intra_process_comm = rclcpp::IntraProcessSetting::Disable;
#endif
    const auto latched = rclcpp::QoS(1).transient_local();
    description_ = node->create_publisher<std_msgs::msg::String>("robot_description", latched,
                                                                 latched_options);
    tf_ = node->create_publisher<tf2_msgs::msg::TFMessage>("/tf_static", latched, latched_options);
    joints_ = node->create_publisher<sensor_msgs::msg::JointState>("joint_states", 10);
    info_ = node->create_publisher<sensor_msgs::msg::CameraInfo>("depth/camera_info", 10);
    depth_ = node->create_publisher<Image>("depth/image", 10);
    points_ = node->create_publisher<sensor_msgs::msg::PointCloud2>("points", 10);
    detections_ = node->create_publisher<vision_msgs::msg::Detection2DArray>("boxes", 10);
    std::ifstream urdf(recording.robots.front().urdf);
    std_msgs::msg::String text;
    text.data.assign(std::istreambuf_iterator<char>(urdf), {});
    description_->publish(text);
    tf2_msgs::msg::TFMessage mount;
    auto& transform = mount.transforms.emplace_back();
    transform.header.frame_id = recording.camera.camera.parent;
    transform.child_frame_id = frame_id;
    const Eigen::Vector3d at = recording.camera.camera.T_parent_camera->translation();
    const Eigen::Quaterniond turn(recording.camera.camera.T_parent_camera->linear());
    transform.transform.translation.x = at.x();
    transform.transform.translation.y = at.y();
    transform.transform.translation.z = at.z();
    transform.transform.rotation.x = turn.x();
    transform.transform.rotation.y = turn.y();
    transform.transform.rotation.z = turn.z();
    transform.transform.rotation.w = turn.w();
    tf_->publish(mount);
  }

  [[nodiscard]] bool is_heard() const {
    return depth_->get_subscription_count() > 0 && joints_->get_subscription_count() > 0 &&
           info_->get_subscription_count() > 0;
  }

  /// Publishes a frame `later` nanoseconds after its recorded stamp. Returns the address of its
  /// pixels.
  const void* play(std::size_t index, std::int64_t later = 0) {
    const penumbra::Frame data = reader.read(index, false);
    const rclcpp::Time stamp(*data.stamp + later);
    sensor_msgs::msg::JointState joints;
    joints.header.stamp = stamp;
    for (std::size_t i = 0; i < robot.variables().size(); ++i) {
      if (robot.variables()[i] == unheard) continue;
      joints.name.push_back(before_names + robot.variables()[i]);
      joints.position.push_back(data.pose.positions[i]);
    }
    joints_->publish(joints);
    const auto pixels = std::get<penumbra::ImageView<const std::uint16_t>>(data.depth.view);
    sensor_msgs::msg::CameraInfo info;
    info.header.stamp = stamp;
    info.header.frame_id = frame_id;
    info.width = static_cast<std::uint32_t>(pixels.width);
    info.height = static_cast<std::uint32_t>(pixels.height);
    info.distortion_model = "plumb_bob";
    info.d.assign(5, 0.0);
    const penumbra::Intrinsics& lens = recording.camera.camera.intrinsics;
    info.k = {lens.fx(), 0, lens.cx(), 0, lens.fy(), lens.cy(), 0, 0, 1};
    info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    info.p = {lens.fx(), 0, lens.cx(), 0, 0, lens.fy(), lens.cy(), 0, 0, 0, 1, 0};
    info_->publish(info);
    auto image = std::make_unique<Image>();
    image->header = info.header;
    image->width = info.width;
    image->height = info.height;
    image->encoding = "16UC1";
    image->step = 2 * image->width;
    const auto* first = reinterpret_cast<const std::uint8_t*>(pixels.data);
    image->data.assign(first, first + image->step * image->height);
    const void* address = image->data.data();
    vision_msgs::msg::Detection2DArray boxes;
    boxes.header = info.header;
    auto& box = boxes.detections.emplace_back();  // of a can on the table
    box.id = "can";
    box.bbox.center.position.x = 479;
    box.bbox.center.position.y = 221;
    box.bbox.size_x = 38;
    box.bbox.size_y = 98;
    detections_->publish(boxes);
    if (points_->get_subscription_count() > 0) points_->publish(points_of(info.header, pixels));
    depth_->publish(std::move(image));
    return address;
  }

  /// Returns the depth image's points, in rows as it has them; NaN where it has no depth.
  [[nodiscard]] sensor_msgs::msg::PointCloud2 points_of(
      const std_msgs::msg::Header& header, penumbra::ImageView<const std::uint16_t> depth) const {
    const penumbra::Intrinsics& lens = recording.camera.camera.intrinsics;
    std::vector<float> xyz;
    for (int v = 0; v < depth.height; ++v)
      for (int u = 0; u < depth.width; ++u) {
        const std::uint16_t millimetres = depth.row(v)[u];
        const double z = millimetres > 0 ? 1e-3 * millimetres : std::nan("");
        for (const double x : {z * (u - lens.cx()) / lens.fx(), z * (v - lens.cy()) / lens.fy(), z})
          xyz.push_back(static_cast<float>(x));
      }
    sensor_msgs::msg::PointCloud2 cloud;
    cloud.header = header;
    cloud.width = static_cast<std::uint32_t>(depth.width);
    cloud.height = static_cast<std::uint32_t>(depth.height);
    for (const char* name : {"x", "y", "z"}) {
      auto& field = cloud.fields.emplace_back();
      field.name = name;
      field.offset = static_cast<std::uint32_t>(4 * (cloud.fields.size() - 1));
      field.datatype = sensor_msgs::msg::PointField::FLOAT32;
      field.count = 1;
    }
    cloud.point_step = 12;
    cloud.row_step = 12 * cloud.width;
    const auto* first = reinterpret_cast<const std::uint8_t*>(xyz.data());
    cloud.data.assign(first, first + 4 * xyz.size());
    return cloud;
  }

  static constexpr const char* frame_id = "camera_depth_optical_frame";
  rclcpp::Node::SharedPtr node;
  penumbra::io::Recording recording;
  penumbra::Robot robot;
  penumbra::io::FrameReader reader;
  std::string unheard;       ///< a joint that no joint state has
  std::string before_names;  ///< of the others in joint states

 private:
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr description_;
  rclcpp::Publisher<tf2_msgs::msg::TFMessage>::SharedPtr tf_;
  rclcpp::Publisher<sensor_msgs::msg::JointState>::SharedPtr joints_;
  rclcpp::Publisher<sensor_msgs::msg::CameraInfo>::SharedPtr info_;
  rclcpp::Publisher<Image>::SharedPtr depth_;
  rclcpp::Publisher<sensor_msgs::msg::PointCloud2>::SharedPtr points_;
  rclcpp::Publisher<vision_msgs::msg::Detection2DArray>::SharedPtr detections_;
};

}  // namespace penumbra_ros::test
