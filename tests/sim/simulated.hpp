// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <sim/simulation.hpp>

/// Skips the running test where the build has no simulation.
#define PENUMBRA_REQUIRE_SIMULATION() \
  if (penumbra::sim::Simulation::scenes().empty()) GTEST_SKIP() << "skipped: no MuJoCo"

namespace penumbra::test {

/// True depths, true joints.
[[nodiscard]] inline sim::SimulationOptions without_noise(std::uint64_t seed) {
  sim::SimulationOptions options;
  options.seed = seed;
  options.depth = {};
  return options;
}

}  // namespace penumbra::test
