// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace penumbra::test {

/// Returns whether PENUMBRA_REQUIRE, a comma-separated list, contains "data", "opengl" or
/// "simulation". Tests skip if one is missing that is not listed.
inline bool is_required(std::string_view what) {
  const char* const given = std::getenv("PENUMBRA_REQUIRE");
  if (given == nullptr) return false;
  std::string words = "," + std::string(given) + ",";
  return words.find("," + std::string(what) + ",") != std::string::npos;
}

/// Returns whether something optional is available. Fails the running test if it is required and
/// missing.
inline bool is_there(bool found, std::string_view what) {
  if (!found && is_required(what))
    ADD_FAILURE() << "PENUMBRA_REQUIRE asks for " << what << ", which is not here";
  return found;
}

}  // namespace penumbra::test
