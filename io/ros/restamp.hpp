// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Changes the stamps of headers (std_msgs/Header) of messages in CDR: the header at the beginning
/// of a message, and all headers of tf2_msgs/TFMessage and of vision_msgs' detection arrays.
class Restamper {
 public:
  /// Throws InputError as MessageDefinition does.
  Restamper(std::string_view type, std::string_view definition);

  /// Returns whether any stamps are changed.
  [[nodiscard]] bool has_headers() const { return find_headers_ != nullptr; }

  /// Returns whether the type has headers that are not changed, or may have (without a definition).
  [[nodiscard]] bool leaves_headers() const { return leaves_headers_; }

  /// Replaces each stamp, nanoseconds, by the result of `change`. Keeps stamps of 0, which mean no
  /// time, and stamps whose result is beyond the range of ROS's time. Returns what is wrong with
  /// the payload, which is then unchanged.
  std::optional<std::string> apply(std::span<std::byte> payload,
                                   const std::function<std::int64_t(std::int64_t)>& change) const;

 private:
  using Headers = std::vector<MessageHeader>;

  std::optional<std::string> (*find_headers_)(std::span<const std::byte>, Headers&) = nullptr;
  bool leaves_headers_ = false;
};

}  // namespace penumbra::io
