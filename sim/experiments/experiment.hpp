// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace penumbra::sim {

class Detector;
class KeypointDetector;
struct Cell;

/// Makes what finds the object in a run's images: a network of one's own, say. Called once per run
/// with what is known of the cell and the run's seed, by several threads at once.
template <typename T>
using DetectorMaker = std::function<std::unique_ptr<T>(const Cell& cell, std::uint64_t seed)>;

struct ExperimentOptions {
  std::string experiment;        ///< one of experiments()
  std::uint64_t first_seed = 0;  ///< seeds first_seed <= seed < end_seed
  std::uint64_t end_seed = 30;
  double duration = 0;           ///< seconds of each run; 0: the scene's own
  int threads = 0;               ///< seeds side by side; 0: as many as the machine has cores
  bool frames = false;           ///< also write the first seed's annotated frames
  std::filesystem::path output;  ///< folder; made if need be
  DetectorMaker<Detector> detector = {};  ///< conveyor: in place of the simulated ones
  DetectorMaker<KeypointDetector> keypoint_detector = {};  ///< handover: likewise
};

/// conveyor, handover.
[[nodiscard]] const std::vector<std::string>& experiments();

/// Runs an experiment and writes metrics.json and report.html (and frames/000000.png). `total` is
/// told how many steps there are, then `step` is called for each, from any thread but never from
/// two at once. Results do not depend on the number of threads. Throws InputError for an experiment
/// that is not known, a range without seeds, a folder that cannot be written, or a build or machine
/// without what it needs.
void run_experiment(const ExperimentOptions& options, const std::function<void(std::size_t)>& total,
                    const std::function<void()>& step);

}  // namespace penumbra::sim
