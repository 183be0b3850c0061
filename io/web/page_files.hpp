// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

namespace penumbra::io {

/// A file of the page that is built into the program.
struct PageFile {
  std::string_view path;  ///< "/index.html"
  std::string_view type;  ///< "text/html; charset=utf-8"
  std::string_view bytes;
};

/// Returns all files of web/dist; embed_files.cmake generates it.
[[nodiscard]] std::span<const PageFile> page_files();

/// Returns the file with this path, or null.
[[nodiscard]] inline const PageFile* find_page_file(std::string_view path) {
  const std::span<const PageFile> files = page_files();
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&](const PageFile& file) { return file.path == path; });
  return found == files.end() ? nullptr : &*found;
}

}  // namespace penumbra::io
