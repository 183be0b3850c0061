// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include <io/ros/image_codec.hpp>

namespace penumbra::io {

/// Returns whether the message was made by the transport "compressedDepth".
[[nodiscard]] bool is_compressed_depth(const CompressedImageMessage& message);

/// Reads a message of that transport: twelve bytes of parameters, then PNG or RVL. A quantised
/// depth q of 32FC1 is a / (q - b) metres, and NaN for q = 0.
[[nodiscard]] std::optional<std::string> decode_compressed_depth(
    const CompressedImageMessage& message, SharedDepth& depth);

/// Unpacks depths that were packed with RVL (A. Wilson, "Fast lossless depth image compression",
/// ISS 2017): runs of zeros and of differences, in groups of three bits. Returns what is wrong, or
/// nothing. `packed` must hold all of `depths` and nothing more.
[[nodiscard]] std::optional<std::string> decode_rvl(std::span<const std::byte> packed,
                                                    std::span<std::uint16_t> depths);

}  // namespace penumbra::io
