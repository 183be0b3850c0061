// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/pipeline/pipeline.hpp>

#include <sim/experiments/sensed.hpp>
#include <sim/simulation.hpp>

namespace penumbra::sim {

/// Runs the pipeline on a simulation's frames.
class RobotWatcher {
 public:
  explicit RobotWatcher(const Simulation& simulation);

  /// What may be known of the frame; valid until the next call, and while the frame lives.
  [[nodiscard]] Sensed see(const SimFrame& frame);

  [[nodiscard]] const Robot& robot() const { return pipeline_.robot(); }
  [[nodiscard]] const LabelRule& rule() const { return pipeline_.rule(); }

  /// How far a point in the base frame lies from the robot's surface, metres; nothing where
  /// further than `most`.
  [[nodiscard]] std::optional<double> distance_to_robot(std::span<const double> joints,
                                                        const Eigen::Vector3d& point,
                                                        double most) const;

 private:
  Pipeline pipeline_;
};

}  // namespace penumbra::sim
