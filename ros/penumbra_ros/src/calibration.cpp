// SPDX-License-Identifier: Apache-2.0
#include "calibration.hpp"

#include <io/files/pose_file.hpp>

namespace penumbra_ros {
namespace {

geometry_msgs::msg::TransformStamped to_message(const penumbra::io::TransformMessage& from) {
  geometry_msgs::msg::TransformStamped message;
  message.header.frame_id = from.header.frame_id;
  message.child_frame_id = from.child_frame_id;
  const Eigen::Vector3d at = from.T_parent_child.translation();
  const Eigen::Quaterniond turn(from.T_parent_child.linear());
  message.transform.translation.x = at.x();
  message.transform.translation.y = at.y();
  message.transform.translation.z = at.z();
  message.transform.rotation.x = turn.x();
  message.transform.rotation.y = turn.y();
  message.transform.rotation.z = turn.z();
  message.transform.rotation.w = turn.w();
  return message;
}

}  // namespace

CalibrationServices::CalibrationServices(rclcpp_lifecycle::LifecycleNode& node,
                                         const std::string& below, penumbra::io::LiveRunner& runner,
                                         std::size_t camera)
    : runner_(runner),
      camera_(camera),
      calibrate_(node.create_service<Calibrate>(
          below + "calibrate",
          [this, clock = node.get_clock()](const Calibrate::Request::SharedPtr request,
                                           Calibrate::Response::SharedPtr response) {
            calibrate(*request, *response);
            response->transform.header.stamp = clock->now();
          })),
      apply_(node.create_service<Trigger>(
          below + "apply_calibration",
          [this](const Trigger::Request::SharedPtr, Trigger::Response::SharedPtr response) {
            apply(*response);
          })) {}

/// Returns the command that publishes the found pose in TF, or an empty text.
std::string CalibrationServices::command() const {
  const auto transform = runner_.calibrated_transform(camera_);
  return transform
             ? penumbra::io::static_transform_command(
                   transform->T_parent_child, transform->header.frame_id, transform->child_frame_id)
             : std::string();
}

void CalibrationServices::calibrate(const Calibrate::Request& request,
                                    Calibrate::Response& response) {
  penumbra::RunningCalibration& calibration = runner_.calibration(camera_);
  penumbra::CalibrationProgress of = runner_.calibration_progress(camera_);
  const bool begins = request.again || !of.is_running;
  const bool is_other = of.is_running && request.search != of.is_search;
  if (begins) calibration.begin(request.search);
  of = runner_.calibration_progress(camera_);
  response.success = begins || !is_other;
  response.message = begins ? "begun: " + of.message : of.message;
  if (!begins) response.message = "it runs already: " + of.message;
  if (!begins && is_other)
    response.message += std::string("; it began ") + (of.is_search ? "without" : "with") +
                        " a first guess: set again to begin anew";
  response.poses = static_cast<std::uint32_t>(of.poses);
  response.found = of.is_ready();
  if (!response.found) return;
  response.position_error = of.found->position_error();
  response.rotation_error = of.found->rotation_error();
  const auto transform = runner_.calibrated_transform(camera_);
  if (!transform) return;
  response.transform = to_message(*transform);
  response.command = command();
}

void CalibrationServices::apply(Trigger::Response& response) {
  const std::string publish = command();
  response.message = runner_.apply_calibration(camera_);
  response.success = response.message.empty();
  if (!response.success) return;
  response.message =
      "images are judged with the pose that was found, until the node is configured "
      "again";
  response.message +=
      publish.empty() ? "; correct the URDF, which has the camera's pose" : "; for TF: " + publish;
}

}  // namespace penumbra_ros
