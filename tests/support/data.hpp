// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace penumbra::test {

/// Folder of the real robot models and recordings; it may be absent.
inline std::filesystem::path data_folder() {
  const char* given = std::getenv("PENUMBRA_DATA");
  return given != nullptr ? given : PENUMBRA_DATA_DEFAULT;
}

}  // namespace penumbra::test

/// Skips the running test where the data is absent.
#define PENUMBRA_REQUIRE_DATA()                                      \
  if (!std::filesystem::is_directory(penumbra::test::data_folder())) \
  GTEST_SKIP() << "skipped: no data"
