// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <vector>

#include <io/base64.hpp>
#include <io/ros/jpeg.hpp>
#include <io/web/picture_uri.hpp>

namespace penumbra::io {
namespace {

constexpr int picture_quality = 80;  // of JPEG

}  // namespace

std::string picture_uri(ImageView<const Rgb8> image) {
  std::vector<std::byte> jpeg;
  encode_jpeg(image, picture_quality, jpeg);
  return "data:image/jpeg;base64," + base64(jpeg);
}

}  // namespace penumbra::io
