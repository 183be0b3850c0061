// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace penumbra::io {

// How ROS 2 names its topics and types in DDS.

/// "rt/a/b" of "/a/b". Throws InputError for what is no full topic name.
[[nodiscard]] std::string dds_topic(std::string_view topic);

/// "sensor_msgs::msg::dds_::Image_" of "sensor_msgs/msg/Image". Throws InputError for what is none.
[[nodiscard]] std::string dds_type(std::string_view type);

/// The way back; nothing for what is not ROS 2's topics: services, actions' parts, others' names.
[[nodiscard]] std::optional<std::string> ros_topic(std::string_view dds_name);
[[nodiscard]] std::optional<std::string> ros_type(std::string_view dds_name);

}  // namespace penumbra::io
