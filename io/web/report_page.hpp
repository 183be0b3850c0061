// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <penumbra/base/image.hpp>

namespace penumbra::io {

/// The largest report, because browsers do not show larger pages well.
inline constexpr std::size_t most_report_page_bytes = std::size_t{64} << 20U;

/// A picture of a page.
struct PagePicture {
  std::size_t index;         ///< of the frame, or of the motion, that it shows
  std::string uri;           ///< "data:image/jpeg;base64,..."
  std::string caption = {};  ///< plain text
};

/// Encodes bytes by RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// Returns a picture's URI, which holds it as a JPEG.
[[nodiscard]] std::string picture_uri(ImageView<const Rgb8> image);

/// Returns report.html as one file: the built-in page with a command's JSON and pictures.
/// web/src/report/main.ts lists the commands that it shows.
[[nodiscard]] std::string report_page(std::string_view json,
                                      std::span<const PagePicture> pictures = {});

}  // namespace penumbra::io
