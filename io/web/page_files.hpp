// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace penumbra::io {

/// A file of the page that is built into the program.
struct PageFile {
  std::string_view path;  ///< "/index.html"
  std::string_view type;  ///< "text/html; charset=utf-8"
  std::string_view bytes;
};

/// Returns the file with this path, or null.
[[nodiscard]] const PageFile* find_page_file(std::string_view path);

}  // namespace penumbra::io
