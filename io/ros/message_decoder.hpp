// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <io/ros/message_definition.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Reads messages of one type. `M`: a struct of messages.hpp for a whole message. Thread-safe.
template <typename M>
class Decoder {
 public:
  /// `type`: as a bag names it; `definition`: its ros2msg text. Throws InputError for another type
  /// than M's, and for a definition whose fields differ from the built-in ones. A type of Foxglove
  /// that is read as M (ros_type_of) has messages in protobuf; its definition is the schema.
  Decoder(std::string_view type, std::string_view definition);

  /// For messages of the built-in definition.
  Decoder() = default;

  /// Reads a payload, which in CDR begins with its encapsulation. Returns what is wrong, one line
  /// that names the type, the field and the byte, or nothing; after a fault the message is
  /// unspecified. Spans of the message refer to the payload. Keeps the message's memory, and takes
  /// at most about thirty times the payload's size.
  [[nodiscard]] std::optional<std::string> decode(std::span<const std::byte> payload,
                                                  M& message) const;

 private:
  std::string foxglove_ = {};  // the schema of messages in protobuf
};

/// Returns the type of M in ROS's spelling, "sensor_msgs/msg/Image".
template <typename M>
[[nodiscard]] std::string message_type() {
  std::string type(M::ros_type);
  return type.replace(type.find('/'), 1, "/msg/");
}

}  // namespace penumbra::io
