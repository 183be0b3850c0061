// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace penumbra::io {

struct MessageText {
  std::string_view type;  ///< "sensor_msgs/Image"
  std::string_view text;  ///< its .msg file without the licence
};

/// The built-in .msg files, sorted by type: made at configure time.
[[nodiscard]] std::span<const MessageText> message_texts();

}  // namespace penumbra::io
