// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/poses/robot_pose.hpp>

namespace penumbra::io {

/// How the messages of a bag or of the live topics are used. Topics are found by type and name
/// where none is given.
struct BagOptions {
  std::optional<std::string> depth_topic, camera_info_topic;
  std::optional<std::string> color_topic;  ///< depth is judged in its image
  /// The camera measures no depth: its colour images are judged by the model alone.
  bool no_depth = false;
  /// Of clouds in place of images: all of their topics, or only these.
  bool clouds = false;
  std::vector<std::string> cloud_topics;
  bool in_other_frame = false;  ///< the clouds' frame need not be their sensor's
  std::vector<std::string> joint_topics, target_topics, plan_topics;
  std::string joint_names;                     ///< see RobotInputOptions
  std::optional<PoseSource> poses;             ///< nothing: joints, or tf where there are none
  std::optional<std::filesystem::path> robot;  ///< in place of /robot_description
  std::map<std::string, std::filesystem::path> packages;
  std::map<std::string, std::string> arguments;  ///< of a xacro file
  /// Of several robots: NS/robot_description, NS/joint_states, frames NS/LINK; empty: one robot.
  std::vector<std::string> robot_namespaces;
  std::string frame_prefix;                   ///< before link names in tf, without a leading "/"
  std::optional<std::string> camera_frame;    ///< in place of the images' frame_id
  std::optional<std::string> parent;          ///< link that the camera is on
  std::optional<std::filesystem::path> pose;  ///< of the camera in that link, in place of tf's
  bool rectified = false;
  std::optional<double> depth_scale;  ///< JudgedCameras
  bool depth_along_ray = false;       ///< likewise
  bool first_publisher = false;       ///< publishers of one joint are not compared
  double time_offset = 0.0;           ///< FrameQueueOptions::time_offset
};

}  // namespace penumbra::io
