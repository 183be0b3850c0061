// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <random>

namespace penumbra::test {

/// A generator with a fixed seed, or the one in PENUMBRA_TEST_SEED; prints which.
inline std::mt19937_64 seeded_random(std::uint64_t default_seed) {
  const char* given = std::getenv("PENUMBRA_TEST_SEED");
  const std::uint64_t seed = given != nullptr ? std::strtoull(given, nullptr, 10) : default_seed;
  std::cout << "seed " << seed << '\n';
  return std::mt19937_64(seed);
}

}  // namespace penumbra::test
