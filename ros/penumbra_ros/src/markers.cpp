// SPDX-License-Identifier: Apache-2.0
#include "markers.hpp"

#include <algorithm>
#include <cmath>

#include <rclcpp/time.hpp>

namespace penumbra_ros {
namespace {

using penumbra::Verdict;
using visualization_msgs::msg::Marker;
using visualization_msgs::msg::MarkerArray;

constexpr float link_opacity = 0.5F;
constexpr double ball_diameter = 0.04;  // metres
constexpr double text_height = 0.03;    // metres
constexpr double golden_ratio = 0.618033988749895;

std_msgs::msg::ColorRGBA color(double r, double g, double b, double a = 1.0) {
  std_msgs::msg::ColorRGBA color;
  color.r = static_cast<float>(r);
  color.g = static_cast<float>(g);
  color.b = static_cast<float>(b);
  color.a = static_cast<float>(a);
  return color;
}

/// Returns colours that differ for neighbouring links.
std_msgs::msg::ColorRGBA color_of_link(std::size_t link) {
  const double hue = 6.0 * std::fmod(static_cast<double>(link) * golden_ratio, 1.0);
  const auto part = [&](double shift) {
    return std::clamp(std::abs(std::fmod(hue + shift, 6.0) - 3.0) - 1.0, 0.0, 1.0);
  };
  return color(part(0.0), part(4.0), part(2.0), link_opacity);
}

std_msgs::msg::ColorRGBA color_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::visible:
      return color(0.1, 0.8, 0.2);
    case Verdict::partial:
      return color(1.0, 0.6, 0.0);
    case Verdict::hidden:
      return color(0.9, 0.1, 0.1);
    case Verdict::held:
      return color(0.3, 0.5, 1.0);
    default:
      return color(0.5, 0.5, 0.5);
  }
}

geometry_msgs::msg::Point point(const Eigen::Vector3d& at) {
  geometry_msgs::msg::Point point;
  point.x = at.x();
  point.y = at.y();
  point.z = at.z();
  return point;
}

std_msgs::msg::Header header_of(const penumbra::FrameReport& report, const std::string& prefix) {
  std_msgs::msg::Header header;
  header.stamp = rclcpp::Time(report.stamp.value_or(0));
  header.frame_id = prefix + report.links.front();
  return header;
}

std::optional<Eigen::Vector3d> place_of(const penumbra::TargetReport& target) {
  if (target.handled && target.handled->position) return target.handled->position;
  return target.point;
}

}  // namespace

std::unique_ptr<MarkerArray> link_markers(const penumbra::Robot& robot,
                                          const std::string& frame_prefix) {
  auto array = std::make_unique<MarkerArray>();
  array->markers.emplace_back().action = Marker::DELETEALL;
  array->markers.back().header.frame_id = frame_prefix + robot.links().front();
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    if (robot.meshes(link).empty()) continue;
    Marker& marker = array->markers.emplace_back();
    marker.header.frame_id = frame_prefix + robot.links()[link];
    marker.ns = "links";
    marker.id = static_cast<int>(link);
    marker.type = Marker::TRIANGLE_LIST;
    marker.frame_locked = true;
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
    marker.color = color_of_link(link);
    for (const penumbra::PreparedMesh& mesh : robot.meshes(link))
      for (const auto& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
          marker.points.push_back(
              point(mesh.vertices[static_cast<std::size_t>(triangle[corner])].cast<double>()));
  }
  return array;
}

std::unique_ptr<MarkerArray> target_markers(const penumbra::FrameReport& report,
                                            const std::string& frame_prefix) {
  auto array = std::make_unique<MarkerArray>();
  for (std::size_t i = 0; i < report.targets.size(); ++i) {
    const penumbra::TargetReport& target = report.targets[i];
    const auto place = place_of(target);
    if (!place) continue;
    Marker marker;
    marker.header = header_of(report, frame_prefix);
    marker.ns = "targets";
    marker.id = static_cast<int>(2 * i);
    marker.type = Marker::SPHERE;
    marker.lifetime = rclcpp::Duration::from_seconds(0.5);
    marker.scale.x = marker.scale.y = marker.scale.z = ball_diameter;
    marker.color = color_of(target.verdict);
    marker.pose.position = point(*place);
    array->markers.push_back(marker);
    marker.id = static_cast<int>(2 * i + 1);
    marker.type = Marker::TEXT_VIEW_FACING;
    marker.scale.z = text_height;
    marker.text = std::string(target.name) + ": " + std::string(to_string(target.verdict));
    marker.pose.position.z += ball_diameter;
    array->markers.push_back(marker);
  }
  return array;
}

std::unique_ptr<vision_msgs::msg::Detection3DArray> handled_detections(
    const penumbra::FrameReport& report, std::span<const penumbra::Target> targets,
    const std::string& frame_prefix) {
  auto array = std::make_unique<vision_msgs::msg::Detection3DArray>();
  array->header = header_of(report, frame_prefix);
  for (std::size_t i = 0; i < report.targets.size(); ++i) {
    const auto& handled = report.targets[i].handled;
    if (!handled || !handled->position) continue;
    auto& detection = array->detections.emplace_back();
    detection.header = array->header;
    detection.id = report.targets[i].name;
    auto& pose = detection.bbox.center;
    pose.position = point(*handled->position);
    const auto turn = handled->orientation.value_or(Eigen::Quaterniond::Identity());
    pose.orientation.x = turn.x();
    pose.orientation.y = turn.y();
    pose.orientation.z = turn.z();
    pose.orientation.w = turn.w();
    if (i < targets.size())
      if (const auto* box = std::get_if<penumbra::BoxTarget>(&targets[i].shape)) {
        detection.bbox.size.x = box->size.x();
        detection.bbox.size.y = box->size.y();
        detection.bbox.size.z = box->size.z();
      }
    auto& result = detection.results.emplace_back();
    result.hypothesis.class_id = to_string(handled->source);
    result.hypothesis.score = 1.0;
    result.pose.pose = pose;
    for (std::size_t axis = 0; axis < 3; ++axis)
      result.pose.covariance[7 * axis] = handled->sigma * handled->sigma;
  }
  return array;
}

std::vector<geometry_msgs::msg::TransformStamped> frames_of(
    const vision_msgs::msg::Detection3DArray& detections) {
  std::vector<geometry_msgs::msg::TransformStamped> frames;
  for (const auto& detection : detections.detections) {
    auto& frame = frames.emplace_back();
    frame.header = detection.header;
    frame.child_frame_id = detection.id;
    std::replace(frame.child_frame_id.begin(), frame.child_frame_id.end(), ' ', '_');
    if (frame.child_frame_id.front() == '/') frame.child_frame_id.erase(0, 1);
    const auto& pose = detection.bbox.center;
    frame.transform.translation.x = pose.position.x;
    frame.transform.translation.y = pose.position.y;
    frame.transform.translation.z = pose.position.z;
    frame.transform.rotation = pose.orientation;
  }
  return frames;
}

}  // namespace penumbra_ros
