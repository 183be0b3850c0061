// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace penumbra::test {

/// Whether PENUMBRA_REQUIRE, words with commas between them, names what tests may else go without:
/// "data", "opengl" or "simulation".
inline bool is_required(std::string_view what) {
  const char* const given = std::getenv("PENUMBRA_REQUIRE");
  if (given == nullptr) return false;
  std::string words = "," + std::string(given) + ",";
  return words.find("," + std::string(what) + ",") != std::string::npos;
}

/// Whether something that tests may skip for is there. Fails the running test where it is required
/// and missing.
inline bool is_there(bool found, std::string_view what) {
  if (!found && is_required(what))
    ADD_FAILURE() << "PENUMBRA_REQUIRE asks for " << what << ", which is not here";
  return found;
}

}  // namespace penumbra::test
