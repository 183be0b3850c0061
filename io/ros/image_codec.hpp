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

/// A depth image of a message. `view` refers to the message's payload where it can be used as it
/// lies, else to one of the buffers; it is empty after a fault.
struct DecodedDepth {
  DepthView view;
  Image<std::uint16_t> millimetres;
  Image<float> metres;
};

// Each answers what is wrong with the message's image, one line, or nothing. After a fault the
// image is unspecified. Buffers are kept where the size stays.

/// 16UC1 and mono16 as millimetres, 32FC1 as metres; either byte order, rows of any step.
[[nodiscard]] std::optional<std::string> decode_depth(const ImageMessage& message,
                                                      DecodedDepth& depth);

/// PNG of 16-bit grey as millimetres, and what the transport "compressedDepth" makes of 16UC1 and
/// 32FC1: PNG or RVL.
[[nodiscard]] std::optional<std::string> decode_depth(const CompressedImageMessage& message,
                                                      DecodedDepth& depth);

/// rgb8, bgr8, rgba8, bgra8 (without alpha), mono8, yuv422 (UYVY) and yuv422_yuy2 (YUYV), the last
/// two in BT.601's narrow range.
[[nodiscard]] std::optional<std::string> decode_colour(const ImageMessage& message,
                                                       Image<Rgb8>& image);

/// PNG and JPEG, whatever the message's format says.
[[nodiscard]] std::optional<std::string> decode_colour(const CompressedImageMessage& message,
                                                       Image<Rgb8>& image);

/// A message of an image whose rows lie without gaps, to which it refers. `encoding`: ROS's name of
/// the pixels' format.
template <typename T>
[[nodiscard]] ImageMessage image_message(const MessageHeader& header, std::string_view encoding,
                                         ImageView<const T> image);

/// A message of format "png", which refers to `png`, where the image is put.
[[nodiscard]] CompressedImageMessage png_message(const MessageHeader& header,
                                                 ImageView<const Rgb8> image,
                                                 std::vector<std::byte>& png);

}  // namespace penumbra::io
