// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// Reads a JPEG file in memory, grey or colour. Reuses the buffer of `image` if the size stays the
/// same. Returns what is wrong (damaged data too, which libjpeg would fill with grey), or nothing.
/// After a fault the image is unspecified. Allocates no more than the file can hold.
[[nodiscard]] std::optional<std::string> decode_jpeg(std::span<const std::byte> bytes,
                                                     Image<Rgb8>& image);

/// Replaces the content of `bytes` by a JPEG file with chroma of half the size, as cameras write
/// it. `quality`: 1 to 100.
void encode_jpeg(ImageView<const Rgb8> image, int quality, std::vector<std::byte>& bytes);

}  // namespace penumbra::io
