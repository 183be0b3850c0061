// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace penumbra::io {

/// The content of a topic.
enum class TopicRole {
  description,
  joints,
  unused_joints,  ///< joint states that are not used: read for the names that they have
  transforms,
  static_transforms,
  depth,
  camera_info,
  color,
  color_info,
  targets,
  cloud,     ///< points: PointCloud2, LaserScan or Livox's CustomMsg
  attached,  ///< what MoveIt attaches to the robot
  plan       ///< motions that the robot will follow
};

/// A topic whose messages FrameAssembler takes.
struct InputTopic {
  TopicRole role = TopicRole::depth;
  std::size_t camera = 0;  ///< for topics of one camera; for clouds: the number of the sensor
  std::string robot = {};  ///< for topics of one of several robots: its name
  std::string name = {};
  std::string type = {};        ///< empty if there are several, see FrameAssembler::set_type
  bool latched = false;         ///< published once, and kept for late subscribers
  std::string definition = {};  ///< see make_handler
};

}  // namespace penumbra::io
