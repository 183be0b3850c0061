// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/required.hpp"

#include <gtest/gtest.h>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

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

/// Depths with a depth camera's noise, or true ones; no colours.
[[nodiscard]] inline sim::SimulationOptions without_color(std::uint64_t seed, bool noisy) {
  sim::SimulationOptions options = without_noise(seed);
  if (noisy) options.depth = sim::DepthNoise::d415();
  options.color = false;
  return options;
}

[[nodiscard]] inline Robot visual_robot(const sim::Simulation& simulation) {
  RobotOptions options;
  options.geometry = Geometry::visual;
  return Robot::load(simulation.urdf(), options);
}

[[nodiscard]] inline PipelineConfig config_of(const sim::Simulation& simulation) {
  PipelineConfig config;
  config.T_parent_camera = simulation.T_base_camera();
  return config;
}

}  // namespace penumbra::test
