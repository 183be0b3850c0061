// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

// Each returns what is wrong with the message's image, one line, or nothing. After a fault a depth
// image is empty and a colour image unspecified.

/// 16UC1 and mono16 as millimetres, 32FC1 as metres; either byte order, rows of any step. Pixels
/// that can be used in place are, and `owner` keeps them.
[[nodiscard]] std::optional<std::string> decode_depth(
    const ImageMessage& message, SharedDepth& depth,
    const std::shared_ptr<const void>& owner = nullptr);

/// PNG of 16-bit grey as millimetres, and the transport "compressedDepth" of 16UC1 and 32FC1: PNG
/// or RVL.
[[nodiscard]] std::optional<std::string> decode_depth(const CompressedImageMessage& message,
                                                      SharedDepth& depth);

/// rgb8, bgr8, rgba8, bgra8 (without alpha), mono8, yuv422 (UYVY) and yuv422_yuy2 (YUYV), the last
/// two in BT.601's narrow range.
[[nodiscard]] std::optional<std::string> decode_color(const ImageMessage& message,
                                                      Image<Rgb8>& image);

/// PNG and JPEG, whatever the message's format says.
[[nodiscard]] std::optional<std::string> decode_color(const CompressedImageMessage& message,
                                                      Image<Rgb8>& image);

/// Returns a message that refers to an image without gaps between its rows. `encoding`: ROS's name
/// of the pixel format.
template <typename T>
[[nodiscard]] ImageMessage image_message(const MessageHeader& header, std::string_view encoding,
                                         ImageView<const T> image);

/// Encodes the image into `png` and returns a message that refers to it.
[[nodiscard]] CompressedImageMessage png_message(const MessageHeader& header,
                                                 ImageView<const Rgb8> image,
                                                 std::vector<std::byte>& png);

}  // namespace penumbra::io
