// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <penumbra/base/image.hpp>

#include <io/png.hpp>

namespace penumbra::io {

/// A picture for a page that is one file: "data:image/jpeg;base64,...".
[[nodiscard]] std::string picture_uri(ImageView<const Rgb8> image);

}  // namespace penumbra::io
