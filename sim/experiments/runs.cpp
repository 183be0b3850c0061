// SPDX-License-Identifier: Apache-2.0
#include <mutex>

#include <sim/experiments/runs.hpp>

namespace penumbra::sim {

SimulationOptions simulation_options(const RunSettings& settings, std::uint64_t seed) {
  SimulationOptions options;
  options.seed = seed;
  options.joint_sigma = settings.joint_sigma;
  options.joint_latency = settings.joint_latency;
  options.belt_jitter = settings.belt_jitter;
  options.second_camera = true;
  options.duration = settings.duration;
  return options;
}

Simulation make_simulation(const std::string& scene, const SimulationOptions& options) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  return {scene, options};
}

Cell cell_of(const Simulation& simulation) {
  return {.camera = simulation.camera(),
          .T_base_camera = simulation.T_base_camera(),
          .second_camera = simulation.second_camera(),
          .T_base_second_camera = simulation.T_base_second_camera(),
          .rule = {},
          .object_size = simulation.object_size(),
          .conveyor_direction = simulation.conveyor_direction()};
}

}  // namespace penumbra::sim
