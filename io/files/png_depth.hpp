// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <penumbra/base/image.hpp>

#include <io/files/image_size.hpp>

namespace penumbra::io {

/// Decodes a PNG file of 16-bit grey, as depth images are stored, three times as fast as libpng,
/// which undoes the filter of such pixels byte by byte. Returns false for any other file, for a
/// damaged one and for another size than wanted: libpng then reads it or says what is wrong.
[[nodiscard]] bool decode_depth_png(std::span<const std::byte> bytes, Image<std::uint16_t>& image,
                                    std::optional<ImageSize> wanted);

}  // namespace penumbra::io
