// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <stdexcept>
#include <string_view>

#include <webp/encode.h>

#include <sim/experiments/picture_data.hpp>

namespace penumbra::sim {
namespace {

constexpr float quality = 82.0F;  // of 100: boxes' edges stay sharp

std::string base64(std::basic_string_view<std::uint8_t> bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<std::uint32_t>(bytes[i + k]) : 0U;
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

}  // namespace

std::string data_uri(const Image<io::Rgb8>& image) {
  static_assert(sizeof(io::Rgb8) == 3);
  std::uint8_t* bytes = nullptr;
  const std::size_t size =
      WebPEncodeRGB(reinterpret_cast<const std::uint8_t*>(image.data()), image.width(),
                    image.height(), image.width() * 3, quality, &bytes);
  const std::unique_ptr<std::uint8_t, decltype(&WebPFree)> owner(bytes, &WebPFree);
  if (size == 0) throw std::runtime_error("a picture of the report could not be compressed");
  return "data:image/webp;base64," + base64({bytes, size});
}

}  // namespace penumbra::sim
