// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <io/ros/foxglove_messages.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::io {

/// A received message: in CDR, with its 4 bytes of encapsulation, and up to 3 bytes of padding may
/// follow; or of a schema of Foxglove in protobuf.
struct SerializedMessage {
  std::span<const std::byte> data;
  /// Keeps `data` alive without a copy; null: pixels that are kept are copied.
  std::shared_ptr<const void> owner = {};
  std::uint64_t publisher = 0;   ///< a unique number on the topic; 0: not known
  std::int64_t source_time = 0;  ///< nanoseconds since 1970: the time of writing; 0: not known
  bool is_skipped = false;       ///< of a video: decoded for later frames only
};

/// Decodes a message and hands it on. Returns why it cannot be decoded, or nothing. `now`:
/// nanoseconds of the caller's clock.
using MessageHandler =
    std::function<std::optional<std::string>(const SerializedMessage& message, std::int64_t now)>;

/// Returns whether messages of a type, as a bag names it, are read as M.
template <typename M>
[[nodiscard]] bool is_read_as(std::string_view type) {
  return ros_type_of(type) == message_type<M>();
}

/// Returns a handler that calls `take(decoded, message, now)`. `topic`: a BagTopic or an
/// InputTopic; one in CDR without a definition has the built-in one. Throws InputError for a
/// definition that the decoder refuses.
template <typename M, typename F>
[[nodiscard]] MessageHandler make_handler(const auto& topic, F take) {
  const bool is_built_in = topic.definition.empty() && ros_type_of(topic.type) == topic.type;
  auto decoder = is_built_in ? Decoder<M>() : Decoder<M>(topic.type, topic.definition);
  return [decoder, take = std::move(take)](const SerializedMessage& message, std::int64_t now) {
    M decoded;
    auto fault = decoder.decode(message.data, decoded);
    if (!fault) take(decoded, message, now);
    return fault;
  };
}

}  // namespace penumbra::io
