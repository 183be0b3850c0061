// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "required.hpp"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace penumbra::test {

/// Folder of the real robot models and recordings; it may be absent.
inline std::filesystem::path data_folder() {
  const char* given = std::getenv("PENUMBRA_DATA");
  return given != nullptr ? given : PENUMBRA_DATA_DEFAULT;
}

inline bool has_data() { return is_there(std::filesystem::is_directory(data_folder()), "data"); }

}  // namespace penumbra::test

/// Skips the running test where the data is absent.
#define PENUMBRA_REQUIRE_DATA() \
  if (!penumbra::test::has_data()) GTEST_SKIP() << "skipped: no data"
