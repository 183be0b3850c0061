// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>

#include <webp/encode.h>

#include <io/base64.hpp>
#include <sim/experiments/picture_data.hpp>

namespace penumbra::sim {
namespace {

constexpr float quality = 82.0F;  // of 100: boxes' edges stay sharp

}  // namespace

std::string data_uri(const Image<io::Rgb8>& image) {
  static_assert(sizeof(io::Rgb8) == 3);
  std::uint8_t* bytes = nullptr;
  const std::size_t size =
      WebPEncodeRGB(reinterpret_cast<const std::uint8_t*>(image.data()), image.width(),
                    image.height(), image.width() * 3, quality, &bytes);
  const std::unique_ptr<std::uint8_t, decltype(&WebPFree)> owner(bytes, &WebPFree);
  if (size == 0) throw std::runtime_error("a picture of the report could not be compressed");
  return "data:image/webp;base64," + io::base64(std::as_bytes(std::span(bytes, size)));
}

}  // namespace penumbra::sim
