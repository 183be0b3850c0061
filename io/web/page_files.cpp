// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <span>

#include <io/web/page_files-inl.hpp>
#include <io/web/page_files.hpp>

namespace penumbra::io {

const PageFile* find_page_file(std::string_view path) {
  const std::span<const PageFile> files = page_files();
  const auto found =
      std::find_if(files.begin(), files.end(), [&](const auto& file) { return file.path == path; });
  return found == files.end() ? nullptr : &*found;
}

}  // namespace penumbra::io
