// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace penumbra::io {

struct ImageSize {
  int width = 0;
  int height = 0;
  bool operator==(const ImageSize&) const = default;
};

/// What is wrong with an image of another size than the camera's.
[[nodiscard]] inline std::string wrong_size(ImageSize got, ImageSize wanted) {
  return "has " + std::to_string(got.width) + " x " + std::to_string(got.height) +
         " pixels; the camera has " + std::to_string(wanted.width) + " x " +
         std::to_string(wanted.height);
}

}  // namespace penumbra::io
