// SPDX-License-Identifier: Apache-2.0
// Messages for rviz and for TF.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <geometry_msgs/msg/transform_stamped.hpp>
#include <vision_msgs/msg/detection3_d_array.hpp>
#include <visualization_msgs/msg/marker_array.hpp>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra_ros {

/// Returns the meshes of all drawn links in the frames of the links, each in a colour of its own.
/// Replaces all earlier markers.
[[nodiscard]] std::unique_ptr<visualization_msgs::msg::MarkerArray> link_markers(
    const penumbra::Robot& robot, const std::string& frame_prefix);

/// Returns a ball and a text for each target whose place is known, in the colour of its verdict.
[[nodiscard]] std::unique_ptr<visualization_msgs::msg::MarkerArray> target_markers(
    const penumbra::FrameReport& report, const std::string& frame_prefix);

/// Returns the handled targets that are not lost, in the frame of the root link, at the frame's
/// stamp. `targets`: of the frame. A target without a size has size 0.
[[nodiscard]] std::unique_ptr<vision_msgs::msg::Detection3DArray> handled_detections(
    const penumbra::FrameReport& report, std::span<const penumbra::Target> targets,
    const std::string& frame_prefix);

/// Returns a frame for each detection, with its id as its name.
[[nodiscard]] std::vector<geometry_msgs::msg::TransformStamped> frames_of(
    const vision_msgs::msg::Detection3DArray& detections);

}  // namespace penumbra_ros
