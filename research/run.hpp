// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>

#include <research/method.hpp>
#include <research/seed_run.hpp>
#include <sim/simulation.hpp>

namespace penumbra::research {

/// The true state of the target in one frame.
struct TargetTruth {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the base frame
  double hidden = 0;          ///< fraction of its pixels that the robot hides
  bool seen = false;          ///< it is in the image, and the robot hides nothing of it
  bool before_robot = false;  ///< it is seen in front of the robot
};

/// All methods with one kind of detection. `methods` are those of `run`, in the same order.
struct Lane {
  LaneRun run;
  std::vector<Method> methods;
};

/// One run of an experiment: the scene of one seed, and all methods on its frames.
class Run {
 public:
  Run(const std::string& scene, std::string target, std::uint64_t seed,
      const RunSettings& settings);
  virtual ~Run() = default;
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// Runs to the end of the scene. `done` is called after each frame.
  [[nodiscard]] SeedRun go(const std::function<void(const sim::SimFrame&)>& done);

 protected:
  /// Returns the methods. `seed` is for the detectors.
  virtual std::vector<Lane> make_lanes(const sim::SimFrame& first, std::uint64_t seed) = 0;

  /// Returns what each lane's methods get of a frame; nothing if the target was not detected.
  virtual std::vector<std::optional<View>> perceive(const sim::SimFrame& frame,
                                                    const Observation& observed) = 0;

  /// Returns whether a measured point is on the robot's body.
  [[nodiscard]] virtual bool is_on_robot(const Eigen::Vector3d& surface, const sim::SimFrame& frame,
                                         const TargetTruth& truth) const = 0;

  /// Returns whether the robot reaches its goal with this belief.
  [[nodiscard]] virtual bool succeeds(const Sample& sample) const = 0;

  const RunSettings settings_;
  sim::Simulation simulation_;
  Pipeline pipeline_;
  Cell cell_;

 private:
  [[nodiscard]] Observation observe(const sim::SimFrame& frame);
  [[nodiscard]] TargetTruth truth_of(const sim::SimFrame& frame) const;
  [[nodiscard]] Event event_of(const Answer& answer, const sim::SimFrame& frame,
                               const TargetTruth& truth) const;
  void ask_methods(const sim::SimFrame& frame, const Observation& observed,
                   const TargetTruth& truth);
  void record(std::int64_t stamp, const TargetTruth& truth);

  std::string target_;
  std::mt19937_64 random_;
  std::vector<Lane> lanes_;
  SeedRun run_;
  std::int64_t first_stamp_ = 0;
  std::optional<double> in_view_since_;  // seconds
  std::optional<std::size_t> goal_;      // the frame of the grasp, or in which the hand is reached
};

/// Returns how a seed's scene is simulated.
[[nodiscard]] sim::SimulationOptions simulation_options(const std::string& scene,
                                                        const RunSettings& settings,
                                                        std::uint64_t seed);

/// Experiment 1: an object on a conveyor, picked at the scene's grasp stamp.
[[nodiscard]] std::unique_ptr<Run> make_conveyor_run(std::uint64_t seed,
                                                     const RunSettings& settings);

/// Experiment 2: a hand that the robot hides, and that also moves in front of the robot.
[[nodiscard]] std::unique_ptr<Run> make_handover_run(std::uint64_t seed,
                                                     const RunSettings& settings);

}  // namespace penumbra::research
