// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include <io/ros/image_codec.hpp>

namespace penumbra::io {

/// Whether a message's format names the transport "compressedDepth".
[[nodiscard]] bool is_compressed_depth(const CompressedImageMessage& message);

/// Reads what that transport made: twelve bytes of parameters, then PNG or RVL. A quantised depth q
/// of 32FC1 is a / (q - b) metres, and NaN for q = 0.
[[nodiscard]] std::optional<std::string> decode_compressed_depth(
    const CompressedImageMessage& message, DecodedDepth& depth);

/// PNG of 16-bit grey: millimetres.
[[nodiscard]] std::optional<std::string> decode_depth_png(std::span<const std::byte> png,
                                                          DecodedDepth& depth);

}  // namespace penumbra::io
