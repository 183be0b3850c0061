// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <sim/experiments/detector.hpp>
#include <sim/experiments/experiment.hpp>
#include <sim/experiments/results.hpp>
#include <sim/simulation.hpp>

namespace penumbra::sim {

/// Called while a run goes on.
struct RunHooks {
  std::function<void()> step = [] {};                                 ///< after each frame
  std::function<void(const SimFrame&)> see = [](const SimFrame&) {};  ///< before it is judged
  DetectorMaker<Detector> detector = {};                              ///< ExperimentOptions'
  DetectorMaker<KeypointDetector> keypoint_detector = {};
};

/// Of a seed's run in a scene: conveyor or handover.
[[nodiscard]] SimulationOptions simulation_options(const std::string& scene,
                                                   const RunSettings& settings, std::uint64_t seed);

/// What is known of a simulation's cell beforehand.
[[nodiscard]] Cell cell_of(const Simulation& simulation);

/// Experiment 1: an object on a conveyor, picked at the scene's grasp stamp.
[[nodiscard]] SeedRun run_conveyor(std::uint64_t seed, const RunSettings& settings,
                                   const RunHooks& hooks);

/// Experiment 2: a hand that the robot hides and that moves before it.
[[nodiscard]] SeedRun run_handover(std::uint64_t seed, const RunSettings& settings,
                                   const RunHooks& hooks);

}  // namespace penumbra::sim
