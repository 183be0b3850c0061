// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/required.hpp"

#include <gtest/gtest.h>

#include <sim/simulation.hpp>

/// Skips the running test where the build has no simulation.
#define PENUMBRA_REQUIRE_SIMULATION() \
  if (!penumbra::test::has_simulation()) GTEST_SKIP() << "skipped: no MuJoCo"

namespace penumbra::test {

inline bool has_simulation() { return is_there(!sim::Simulation::scenes().empty(), "simulation"); }

/// True depths, true joints.
[[nodiscard]] inline sim::SimulationOptions without_noise(std::uint64_t seed) {
  sim::SimulationOptions options;
  options.seed = seed;
  options.depth = {};
  return options;
}

}  // namespace penumbra::test
