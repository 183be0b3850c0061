// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// A depth image of a message. `view` refers to the payload if its pixels can be used in place,
/// else to one of the buffers. It is empty after a fault.
struct DecodedDepth {
  DepthView view;
  Image<std::uint16_t> millimetres;
  Image<float> metres;
};

// Each returns what is wrong with the message's image, one line, or nothing. After a fault the
// image is unspecified. Buffers are reused while the size stays the same.

/// 16UC1 and mono16 as millimetres, 32FC1 as metres; either byte order, rows of any step.
[[nodiscard]] std::optional<std::string> decode_depth(const ImageMessage& message,
                                                      DecodedDepth& depth);

/// PNG of 16-bit grey as millimetres, and the transport "compressedDepth" of 16UC1 and 32FC1: PNG
/// or RVL.
[[nodiscard]] std::optional<std::string> decode_depth(const CompressedImageMessage& message,
                                                      DecodedDepth& depth);

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
