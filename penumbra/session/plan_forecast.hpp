// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/planning/look_ahead.hpp>

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

  /// Sets TargetReport::forecast of a frame's targets. Does nothing without a plan, and once the
  /// robot is at its end.
  void add(const Frame& frame, std::span<TargetReport> reports);

 private:
  [[nodiscard]] std::string follow(const Frame& frame);
  [[nodiscard]] std::string look(const Frame& frame);

  Robot robot_;
  ForecastCamera camera_;
  std::shared_ptr<const Trajectory> given_;  // the plan
  std::optional<Trajectory> plan_;           // with the other joints where they are now
  double now_ = 0.0;                         // on the plan, seconds
  bool has_ended_ = false;
  std::optional<LookAhead> ahead_;  // made with the first plan
  std::optional<double> looked_at_;
  std::optional<std::int64_t> looked_stamp_;
  std::vector<TargetForecast> forecasts_;  // from then on, in seconds of the plan
  std::vector<double> positions_;
};

}  // namespace penumbra
