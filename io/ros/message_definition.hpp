// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// The fields of one message type, each as "float64[9] k" or "std_msgs/Header header".
struct MessageFields {
  std::string type = {};  ///< "sensor_msgs/CameraInfo"
  std::vector<std::string> fields = {};
};

/// The fields of a message type and of the types in it, from ROS 2's "ros2msg" text: a .msg file,
/// then those of the types in it, each after a line of "=" and a line "MSG: package/Type".
/// Comments, constants and default values are left out; all names of a type are written alike.
class MessageDefinition {
 public:
  static constexpr std::size_t max_text = std::size_t{1} << 20;  ///< bytes

  /// `type`: "sensor_msgs/msg/Image" or "sensor_msgs/Image". Accepts any text of at most max_text
  /// bytes: a line that is no field equals no field. Throws InputError for a longer one.
  MessageDefinition(std::string_view type, std::string_view text);

  /// The first is the message's own. The last is builtin_interfaces/Time, which texts may omit.
  [[nodiscard]] std::span<const MessageFields> types() const { return types_; }

  /// Returns the first difference from the expected fields of one type, or an empty string.
  [[nodiscard]] std::string difference(const MessageFields& expected) const;

 private:
  std::vector<MessageFields> types_;
};

/// Returns "sensor_msgs/Image" for "sensor_msgs/msg/Image", and other names unchanged.
[[nodiscard]] std::string short_type(std::string_view type);

/// Returns the first difference of a definition from the built-in one of `type`, or an empty
/// string.
[[nodiscard]] std::string difference_from_built_in(const MessageDefinition& definition,
                                                   std::string_view type);

/// Returns the built-in text of a type, "sensor_msgs/msg/Image" or "sensor_msgs/Image", as in ROS 2
/// Humble, or an empty text for an unknown type. All messages that are read or written are built
/// in.
[[nodiscard]] std::string_view definition_of(std::string_view type);

}  // namespace penumbra::io
