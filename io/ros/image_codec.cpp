// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include <io/files/depth_pixels.hpp>
#include <io/files/image_size.hpp>
#include <io/files/jpeg.hpp>
#include <io/files/printable.hpp>
#include <io/ros/compressed_depth-inl.hpp>
#include <io/ros/image_codec.hpp>

namespace penumbra::io {
namespace {

/// Conversion of a colour encoding to RGB.
struct ColourFormat {
  std::string_view encoding;  ///< ROS's name
  std::size_t pixel_bytes;
  bool in_pairs;  ///< two pixels share their colour, so widths are even
  void (*convert)(const std::byte* from, Rgb8* to, std::size_t pixels);  ///< a row
};

std::uint8_t octet_of(std::byte byte) { return std::to_integer<std::uint8_t>(byte); }

template <std::size_t r, std::size_t g, std::size_t b, std::size_t bytes>
void convert_plain(const std::byte* from, Rgb8* to, std::size_t pixels) {
  for (std::size_t i = 0; i < pixels; ++i, from += bytes)
    to[i] = {octet_of(from[r]), octet_of(from[g]), octet_of(from[b])};
}

void copy_rgb(const std::byte* from, Rgb8* to, std::size_t pixels) {
  std::memcpy(to, from, 3 * pixels);
}

// What the colour of two pixels adds to their grey, in 1/256.
struct Chroma {
  int r, g, b;
};

// ITU-R BT.601, narrow range: y of 16 to 235, u and v of 16 to 240.
Chroma chroma_of(std::byte u_octet, std::byte v_octet) {
  const int u = octet_of(u_octet) - 128, v = octet_of(v_octet) - 128;
  return {409 * v, -100 * u - 208 * v, 516 * u};
}

// Clamped to 0..255 by a table: values of rgb_of lie in -277 to 534.
constexpr int least_value = -300;
constexpr auto clamped_values = [] {
  std::array<std::uint8_t, 900> values{};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<std::uint8_t>(std::clamp(static_cast<int>(i) + least_value, 0, 255));
  return values;
}();

std::uint8_t clamped_octet(int value) {
  return clamped_values[static_cast<std::size_t>((value >> 8) - least_value)];
}

Rgb8 rgb_of(std::byte y, const Chroma& chroma) {
  const int grey = 298 * (octet_of(y) - 16) + 128;
  return {clamped_octet(grey + chroma.r), clamped_octet(grey + chroma.g),
          clamped_octet(grey + chroma.b)};
}

// Where y of the first pixel, u, y of the second and v stand in four bytes.
template <std::size_t y0, std::size_t u, std::size_t y1, std::size_t v>
void convert_pairs(const std::byte* from, Rgb8* to, std::size_t pixels) {
  for (std::size_t i = 0; i + 1 < pixels; i += 2, from += 4) {
    const Chroma chroma = chroma_of(from[u], from[v]);
    to[i] = rgb_of(from[y0], chroma);
    to[i + 1] = rgb_of(from[y1], chroma);
  }
}

constexpr std::array<ColourFormat, 7> colour_formats = {
    {{"rgb8", 3, false, copy_rgb},
     {"bgr8", 3, false, convert_plain<2, 1, 0, 3>},
     {"rgba8", 4, false, convert_plain<0, 1, 2, 4>},
     {"bgra8", 4, false, convert_plain<2, 1, 0, 4>},
     {"mono8", 1, false, convert_plain<0, 0, 0, 1>},
     {"yuv422", 2, true, convert_pairs<1, 0, 3, 2>},
     {"yuv422_yuy2", 2, true, convert_pairs<0, 1, 2, 3>}}};

const ColourFormat* find_colour_format(std::string_view encoding) {
  const auto* at = std::find_if(colour_formats.begin(), colour_formats.end(),
                                [&](const auto& format) { return format.encoding == encoding; });
  return at == colour_formats.end() ? nullptr : at;
}

// What is wrong with the sizes of a message, or nothing.
std::optional<std::string> check_layout(const ImageMessage& message, std::size_t pixel_bytes) {
  if (auto fault = check_image_size(message.width, message.height)) return fault;
  const std::uint64_t row = std::uint64_t{message.width} * pixel_bytes;
  const std::uint64_t all = std::uint64_t{message.step} * message.height;
  if (message.step >= row && message.data.size() == all) return std::nullopt;
  return "of " + std::to_string(message.width) + " x " + std::to_string(message.height) + " " +
         message.encoding + " has steps of " + std::to_string(message.step) + " bytes and " +
         std::to_string(message.data.size()) + " bytes; expected steps of " + std::to_string(row) +
         " or more, one for each row";
}

template <typename T>
T byte_swapped(T value) {
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  std::reverse(bytes.begin(), bytes.end());
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

template <typename T>
SharedDepth copy_rows(const ImageMessage& message) {
  Image<T> image(static_cast<int>(message.width), static_cast<int>(message.height));
  for (int v = 0; v < image.height(); ++v) {
    T* row = image.view().row(v);
    std::memcpy(row, message.data.data() + std::size_t{message.step} * static_cast<std::size_t>(v),
                message.width * sizeof(T));
    if (message.is_bigendian != 0) std::transform(row, row + message.width, row, byte_swapped<T>);
  }
  return shared_depth_of(std::move(image), {});
}

// The pixels as they lie, if they can be used so.
template <typename T>
std::optional<ImageView<const T>> view_in_place(const ImageMessage& message) {
  const bool aligned = reinterpret_cast<std::uintptr_t>(message.data.data()) % alignof(T) == 0;
  if (message.is_bigendian != 0 || !aligned || message.step % sizeof(T) != 0) return std::nullopt;
  return ImageView<const T>{reinterpret_cast<const T*>(message.data.data()),
                            static_cast<int>(message.width), static_cast<int>(message.height),
                            static_cast<std::ptrdiff_t>(message.step / sizeof(T))};
}

template <typename T>
std::optional<std::string> take_depth(const ImageMessage& message, SharedDepth& depth,
                                      const std::shared_ptr<const void>& owner) {
  if (auto fault = check_layout(message, sizeof(T))) return fault;
  const auto in_place = view_in_place<T>(message);
  depth = in_place ? SharedDepth(*in_place, owner) : copy_rows<T>(message);
  return std::nullopt;
}

std::optional<std::string> of_image(std::string_view what, std::optional<std::string> fault) {
  if (fault) fault->insert(0, std::string(what) + " ");
  return fault;
}

bool begins_with(std::span<const std::byte> bytes, std::string_view signature) {
  return bytes.size() >= signature.size() &&
         std::memcmp(bytes.data(), signature.data(), signature.size()) == 0;
}

}  // namespace

std::optional<std::string> decode_depth(const ImageMessage& message, SharedDepth& depth,
                                        const std::shared_ptr<const void>& owner) {
  depth = {};
  if (message.encoding == "16UC1" || message.encoding == "mono16")
    return of_image("depth image", take_depth<std::uint16_t>(message, depth, owner));
  if (message.encoding == "32FC1")
    return of_image("depth image", take_depth<float>(message, depth, owner));
  return "depth image has encoding '" + printable(message.encoding) +
         "'; expected 16UC1, mono16 or 32FC1";
}

std::optional<std::string> decode_depth(const CompressedImageMessage& message, SharedDepth& depth) {
  depth = {};
  if (is_compressed_depth(message))
    return of_image("depth image", decode_compressed_depth(message, depth));
  Image<std::uint16_t> millimetres;
  if (auto fault = decode_png(message.data, millimetres))
    return of_image("depth image", std::move(fault));
  depth = shared_depth_of(std::move(millimetres), {});
  return std::nullopt;
}

std::optional<std::string> decode_color(const ImageMessage& message, Image<Rgb8>& image) {
  const ColourFormat* format = find_colour_format(message.encoding);
  if (format == nullptr)
    return "colour image has encoding '" + printable(message.encoding) +
           "'; expected rgb8, bgr8, rgba8, bgra8, mono8, yuv422 or yuv422_yuy2";
  if (auto fault = check_layout(message, format->pixel_bytes))
    return of_image("colour image", fault);
  if (format->in_pairs && message.width % 2 != 0)
    return "colour image of " + message.encoding + " has an odd width of " +
           std::to_string(message.width);
  image.fit(static_cast<int>(message.width), static_cast<int>(message.height));
  for (int v = 0; v < image.height(); ++v)
    format->convert(message.data.data() + std::size_t{message.step} * static_cast<std::size_t>(v),
                    image.view().row(v), message.width);
  return std::nullopt;
}

std::optional<std::string> decode_color(const CompressedImageMessage& message, Image<Rgb8>& image) {
  if (begins_with(message.data, "\x89PNG"))
    return of_image("colour image", decode_png(message.data, image));
  if (begins_with(message.data, "\xff\xd8\xff"))
    return of_image("colour image", decode_jpeg(message.data, image));
  return "colour image of format '" + printable(message.format) + "' is neither PNG nor JPEG";
}

template <typename T>
ImageMessage image_message(const MessageHeader& header, std::string_view encoding,
                           ImageView<const T> image) {
  if (image.stride != image.width || image.empty())
    throw std::logic_error("image_message needs an image whose rows lie without gaps");
  ImageMessage message{.header = header, .encoding = std::string(encoding)};
  message.width = static_cast<std::uint32_t>(image.width);
  message.height = static_cast<std::uint32_t>(image.height);
  message.step = message.width * static_cast<std::uint32_t>(sizeof(T));
  message.data = std::as_bytes(std::span(
      image.data, static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)));
  return message;
}

template ImageMessage image_message(const MessageHeader&, std::string_view,
                                    ImageView<const std::uint8_t>);
template ImageMessage image_message(const MessageHeader&, std::string_view,
                                    ImageView<const std::uint16_t>);
template ImageMessage image_message(const MessageHeader&, std::string_view, ImageView<const float>);
template ImageMessage image_message(const MessageHeader&, std::string_view, ImageView<const Rgb8>);

CompressedImageMessage png_message(const MessageHeader& header, ImageView<const Rgb8> image,
                                   std::vector<std::byte>& png) {
  encode_png(image, png);
  return {.header = header, .format = "png", .data = png};
}

}  // namespace penumbra::io
