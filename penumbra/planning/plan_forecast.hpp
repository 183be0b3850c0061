// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra {

/// Says what the rest of Frame::plan will hide, frame by frame while the robot follows it. Where on
/// the plan the robot is, its joints tell: no clock is needed, and a plan that waits for its
/// execution begins when the robot moves.
class PlanForecast {
 public:
  static constexpr double horizon = 2.0;  ///< seconds that are looked ahead
  /// Seconds, of the plan or of stamps, after which targets are looked at anew; between, the
  /// forecast is shifted. Frames without stamps are all looked at.
  static constexpr double refresh = 0.5;
  /// Of a joint from the plan, rad or m: farther, the robot is not on it.
  static constexpr double on_plan = 0.1;

  /// `camera`: of the report's images.
  PlanForecast(const Robot& robot, const Camera& camera, const PipelineConfig& config);
  ~PlanForecast();
  PlanForecast(PlanForecast&&) noexcept;
  PlanForecast& operator=(PlanForecast&&) noexcept;

  /// Returns TargetReport::forecast of each of a frame's targets; empty without a plan, and once
  /// the robot is at its end. Valid until the next call.
  [[nodiscard]] std::span<const Forecast> of(const Frame& frame);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
