// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace penumbra::research {

struct ExperimentOptions {
  std::string experiment;        ///< conveyor or handover
  std::uint64_t first_seed = 0;  ///< seeds first_seed <= seed < end_seed
  std::uint64_t end_seed = 30;
  double duration = 0;           ///< seconds of each run; 0: the scene's own
  int threads = 0;               ///< seeds that run at the same time; 0: one per core
  bool frames = false;           ///< also write the first seed's annotated frames
  std::filesystem::path output;  ///< folder; made if it is not there
};

/// Runs an experiment and writes metrics.json (and frames/000000.png). Calls `step` after each
/// frame with the number of all frames, from any thread but never from two at once. Results do not
/// depend on the number of threads. Throws InputError for an unknown experiment, a range without
/// seeds, a folder that cannot be written, or a machine without OpenGL.
void run_experiment(const ExperimentOptions& options,
                    const std::function<void(std::size_t total)>& step);

}  // namespace penumbra::research
