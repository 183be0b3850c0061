// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace penumbra::io {

// Conversion between the names of topics and types in ROS 2 and in DDS.

/// Returns "rt/a/b" for "/a/b". Throws InputError if it is not a full topic name.
[[nodiscard]] std::string dds_topic(std::string_view topic);

/// Returns "sensor_msgs::msg::dds_::Image_" for "sensor_msgs/msg/Image". Throws InputError if it is
/// not a message type.
[[nodiscard]] std::string dds_type(std::string_view type);

/// Returns the topic of a DDS name, or nothing if it is not a topic of ROS 2: services, parts of
/// actions, other names.
[[nodiscard]] std::optional<std::string> ros_topic(std::string_view dds_name);
[[nodiscard]] std::optional<std::string> ros_type(std::string_view dds_name);

}  // namespace penumbra::io
