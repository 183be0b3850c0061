// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <io/ros/message_definition.hpp>

namespace penumbra::io {

/// Changes the stamps of all headers (std_msgs/Header) of messages in CDR.
class Restamper {
 public:
  /// Throws InputError as MessageDefinition does, and for types with wstring.
  Restamper(std::string_view type, std::string_view definition);

  /// Whether messages of this type have headers at all.
  [[nodiscard]] bool has_headers() const { return has_headers_; }

  /// Replaces each stamp, nanoseconds, by what `change` answers; stamps of 0, which say nothing,
  /// and answers that ROS's time cannot hold stay as they are. Answers what is wrong with the
  /// payload, which is then changed in part.
  std::optional<std::string> apply(std::span<std::byte> payload,
                                   const std::function<std::int64_t(std::int64_t)>& change) const;

 private:
  MessageDefinition definition_;
  bool has_headers_ = false;
};

}  // namespace penumbra::io
