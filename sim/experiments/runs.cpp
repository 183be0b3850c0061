// SPDX-License-Identifier: Apache-2.0
#include <sim/experiments/runs.hpp>

namespace penumbra::sim {

SimulationOptions simulation_options(const std::string& scene, const RunSettings& settings,
                                     std::uint64_t seed) {
  SimulationOptions options;
  options.seed = seed;
  options.joint_sigma = settings.joint_sigma;
  options.joint_latency = settings.joint_latency;
  options.belt_jitter = scene == "conveyor" ? settings.belt_jitter : 0.0;
  options.second_camera = true;
  options.duration = settings.duration;
  return options;
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
