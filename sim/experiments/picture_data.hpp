// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <penumbra/base/image.hpp>

#include <io/png.hpp>

namespace penumbra::sim {

/// An image as the address of itself: data:image/webp;base64,...
[[nodiscard]] std::string data_uri(const Image<io::Rgb8>& image);

}  // namespace penumbra::sim
