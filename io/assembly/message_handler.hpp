// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <io/ros/message_decoder.hpp>

namespace penumbra::io {

/// A received message in CDR, with its 4 bytes of encapsulation. Up to 3 bytes of padding may
/// follow.
struct SerializedMessage {
  std::span<const std::byte> data;
  /// Keeps `data` alive without a copy; null: pixels that are kept are copied.
  std::shared_ptr<const void> owner = {};
  std::uint64_t publisher = 0;   ///< a unique number on the topic; 0: not known
  std::int64_t source_time = 0;  ///< nanoseconds since 1970: the time of writing; 0: not known
};

/// Decodes a message and hands it on. Returns why it cannot be decoded, or nothing. `now`:
/// nanoseconds of the caller's clock.
using MessageHandler =
    std::function<std::optional<std::string>(const SerializedMessage& message, std::int64_t now)>;

/// Returns a handler that calls `take(decoded, message, now)`. `definition`: as BagTopic has it;
/// empty: the built-in one. Throws InputError for a definition that the decoder refuses.
template <typename M, typename F>
[[nodiscard]] MessageHandler make_handler(const std::string& definition, F take) {
  auto decoder = definition.empty() ? Decoder<M>() : Decoder<M>(message_type<M>(), definition);
  return [decoder, take = std::move(take)](const SerializedMessage& message, std::int64_t now) {
    M decoded;
    auto fault = decoder.decode(message.data, decoded);
    if (!fault) take(decoded, message, now);
    return fault;
  };
}

}  // namespace penumbra::io
