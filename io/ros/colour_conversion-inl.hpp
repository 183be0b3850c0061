// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include <io/files/png.hpp>

namespace penumbra::io {

/// How the pixels of a colour image are read.
struct ColourFormat {
  std::string_view encoding;  ///< ROS's name
  std::size_t pixel_bytes;
  bool in_pairs;  ///< two pixels share their colour: widths are even
  void (*convert)(const std::byte* from, Rgb8* to, std::size_t pixels);  ///< a row
};

/// nullptr: it is not read.
[[nodiscard]] const ColourFormat* find_colour_format(std::string_view encoding);

}  // namespace penumbra::io
