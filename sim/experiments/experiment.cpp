// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include <penumbra/base/error.hpp>

#include <sim/experiments/experiment.hpp>
#include <sim/experiments/key_frames.hpp>
#include <sim/experiments/report.hpp>
#include <sim/experiments/runs.hpp>

namespace penumbra::sim {
namespace {

constexpr std::uint64_t most_seeds = 10'000;

void check(const ExperimentOptions& options) {
  const auto& known = experiments();
  if (std::find(known.begin(), known.end(), options.experiment) == known.end())
    throw InputError("experiment: '" + options.experiment + "' is not one of conveyor, handover");
  if (options.first_seed >= options.end_seed || options.end_seed - options.first_seed > most_seeds)
    throw InputError("--seeds: " + std::to_string(options.first_seed) + ":" +
                     std::to_string(options.end_seed) +
                     " is not A:B with A < B, and 10000 seeds at most");
}

SeedRun run_seed(const ExperimentOptions& options, const RunSettings& settings, std::uint64_t seed,
                 const RunHooks& hooks) {
  return options.experiment == "conveyor" ? run_conveyor(seed, settings, hooks)
                                          : run_handover(seed, settings, hooks);
}

/// Runs every seed, several side by side. The first fault ends all.
class SeedRunner {
 public:
  SeedRunner(const ExperimentOptions& options, const RunSettings& settings,
             const std::function<void()>& step)
      : options_(options),
        settings_(settings),
        step_(step),
        runs_(options.end_seed - options.first_seed) {}

  /// `see` is given the frames of the first seed.
  std::vector<SeedRun> go(const std::function<void(const SimFrame&)>& see) {
    const std::size_t cores = std::max(std::thread::hardware_concurrency(), 1U);
    const std::size_t wanted =
        options_.threads > 0 ? static_cast<std::size_t>(options_.threads) : cores;
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < std::min(wanted, runs_.size()); ++i)
      threads.emplace_back([&] { work(see); });
    for (std::thread& thread : threads) thread.join();
    if (fault_) std::rethrow_exception(fault_);
    return std::move(runs_);
  }

 private:
  void work(const std::function<void(const SimFrame&)>& see) {
    for (std::size_t i = next_++; i < runs_.size() && !failed_; i = next_++) {
      RunHooks hooks;
      hooks.step = [&] {
        const std::lock_guard lock(mutex_);
        step_();
      };
      if (i == 0) hooks.see = see;
      hooks.detector = options_.detector;
      hooks.keypoint_detector = options_.keypoint_detector;
      try {
        runs_[i] = run_seed(options_, settings_, options_.first_seed + i, hooks);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failed_.exchange(true)) fault_ = std::current_exception();
      }
    }
  }

  const ExperimentOptions& options_;
  const RunSettings& settings_;
  const std::function<void()>& step_;
  std::vector<SeedRun> runs_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr fault_;
};

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw InputError("-o: " + folder.string() + " cannot be made: " + error.message());
}

void write_frames(const std::filesystem::path& folder, const KeyFrames& frames,
                  const SeedRun& run) {
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    std::string name = std::to_string(i);
    name.insert(0, 6 - std::min<std::size_t>(name.size(), 6), '0');
    const Image<io::Rgb8> image = frames.draw(run, i);
    io::write_png(folder / (name + ".png"), image.view());
  }
}

}  // namespace

const std::vector<std::string>& experiments() {
  static const std::vector<std::string> all{"conveyor", "handover"};
  return all;
}

void run_experiment(const ExperimentOptions& options, const std::function<void(std::size_t)>& total,
                    const std::function<void()>& step) {
  check(options);
  make_folder(options.output);
  if (options.frames) make_folder(options.output / "frames");
  ReportFiles files(options.output);
  RunSettings settings;
  settings.duration = options.duration;
  std::optional<KeyFrames> frames;
  {
    const Simulation simulation(
        options.experiment, simulation_options(options.experiment, settings, options.first_seed));
    frames.emplace(options.experiment, cell_of(simulation));
    total((options.end_seed - options.first_seed) * simulation.frames());
  }
  ExperimentResult result;
  result.experiment = options.experiment;
  result.settings = settings;
  result.seeds = SeedRunner(options, settings, step).go([&](const SimFrame& f) { frames->see(f); });
  result.pictures = frames->choose(result.seeds.front());
  files.write(result);
  if (options.frames) write_frames(options.output / "frames", *frames, result.seeds.front());
}

}  // namespace penumbra::sim
