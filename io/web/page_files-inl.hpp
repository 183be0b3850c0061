// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <io/web/page_files.hpp>

namespace penumbra::io {

/// Returns all files of web/dist; embed_files.cmake generates it.
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace penumbra::io
