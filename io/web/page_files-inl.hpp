// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <io/web/page_files.hpp>

namespace penumbra::io {

/// All of web/dist; made by embed_files.cmake.
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace penumbra::io
