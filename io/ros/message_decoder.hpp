// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Reads messages of one type by a definition, of a bag or built in: fields are found by their
/// names, others are stepped over. `M`: a struct of messages.hpp that stands for a whole message.
/// Safe to be used by several threads at once.
template <typename M>
class Decoder {
 public:
  /// `type` as a bag names it; `definition`: its ros2msg text. Throws InputError, which names what
  /// is wanted, for another type than M's, a text that is no definition, and one that lacks a field
  /// of M or has it as another type.
  Decoder(std::string_view type, std::string_view definition);

  /// By the built-in definition.
  Decoder();

  /// Reads a payload, encapsulation and all. Answers what is wrong, one line that names the type,
  /// the field and the byte, or nothing; after a fault the message is unspecified. Spans of the
  /// message refer to the payload. Keeps the message's memory, and takes in all no more than about
  /// thirty times the payload's size.
  [[nodiscard]] std::optional<std::string> decode(std::span<const std::byte> payload,
                                                  M& message) const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

/// The type that M stands for, "sensor_msgs/msg/Image".
template <typename M>
[[nodiscard]] std::string message_type();

}  // namespace penumbra::io
