// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <exception>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/files/pending_file.hpp>
#include <research/drawn_frames.hpp>
#include <research/experiment.hpp>
#include <research/metrics_json.hpp>
#include <research/run.hpp>

namespace penumbra::research {
namespace {

constexpr std::uint64_t most_seeds = 10'000;

void check(const ExperimentOptions& options) {
  if (options.experiment != "conveyor" && options.experiment != "handover")
    throw InputError("experiment: '" + options.experiment + "' is not one of conveyor, handover");
  if (options.first_seed >= options.end_seed || options.end_seed - options.first_seed > most_seeds)
    throw InputError("--seeds: " + std::to_string(options.first_seed) + ":" +
                     std::to_string(options.end_seed) +
                     " is not A:B with A < B, and 10000 seeds at most");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw InputError("-o: " + folder.string() + " cannot be made: " + error.message());
}

using FrameDone = std::function<void(std::size_t seed_index, const sim::SimFrame& frame)>;

/// Runs every seed, several at the same time. The first fault ends all.
std::vector<SeedRun> run_seeds(const ExperimentOptions& options, const RunSettings& settings,
                               const FrameDone& done) {
  std::vector<SeedRun> runs(options.end_seed - options.first_seed);
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr fault;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < runs.size(); i = next++) {
        const std::uint64_t seed = options.first_seed + i;
        const auto run = options.experiment == "conveyor" ? make_conveyor_run(seed, settings)
                                                          : make_handover_run(seed, settings);
        runs[i] = run->go([&](const sim::SimFrame& frame) {
          const std::lock_guard lock(mutex);
          done(i, frame);
        });
      }
    } catch (...) {
      next = runs.size();
      const std::lock_guard lock(mutex);
      if (!fault) fault = std::current_exception();
    }
  };
  const std::size_t cores = std::max(std::thread::hardware_concurrency(), 1U);
  const std::size_t wanted =
      options.threads > 0 ? static_cast<std::size_t>(options.threads) : cores;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < std::min(wanted, runs.size()); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  if (fault) std::rethrow_exception(fault);
  return runs;
}

}  // namespace

void run_experiment(const ExperimentOptions& options,
                    const std::function<void(std::size_t total)>& step) {
  check(options);
  make_folder(options.output);
  if (options.frames) make_folder(options.output / "frames");
  const std::filesystem::path path = options.output / "metrics.json";
  io::PendingFile pending(path);
  std::ofstream file(pending.part(), std::ios::binary);  // before the runs, which take minutes
  const auto check_file = [&] {
    if (!file) throw InputError("-o: " + path.string() + " cannot be written");
  };
  check_file();
  RunSettings settings;
  settings.duration = options.duration;
  const sim::Simulation first(options.experiment,
                              simulation_options(options.experiment, settings, options.first_seed));
  const std::size_t total = (options.end_seed - options.first_seed) * first.frames();
  DrawnFrames drawn(first);
  ExperimentResult result{options.experiment, {}, settings};
  result.seeds = run_seeds(options, settings, [&](std::size_t i, const sim::SimFrame& frame) {
    if (options.frames && i == 0) drawn.add(frame);
    step(total);
  });
  file << metrics_json(result);
  file.close();
  check_file();
  pending.finish();
  if (options.frames) drawn.write(options.output / "frames", result.seeds.front());
}

}  // namespace penumbra::research
