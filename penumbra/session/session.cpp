// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/session/session.hpp>

namespace penumbra {

Session::Session(Robot robot, const Camera& camera, const PipelineConfig& config,
                 const DriftLimits& limits)
    : pipeline_(std::move(robot), camera, config),
      config_(config),
      limits_(limits),
      warnings_(pipeline_, config_),
      watch_(pipeline_.report_camera(), limits_),
      forecast_(pipeline_.robot(), pipeline_.report_camera(), config_) {}

const FrameReport& Session::process(const Frame& frame) {
  const FrameReport& report = pipeline_.process(frame);
  warnings_.add(report, frame);
  watch_.add(report);
  if (!frame.plan) return report;
  targets_.assign(report.targets.begin(), report.targets.end());
  forecast_.add(frame, targets_);
  report_ = report;
  report_.targets = targets_;
  return report_;
}

std::vector<std::string> Session::warnings() const {
  std::vector<std::string> lines = warnings_.lines();
  const std::string moved = drift().message();
  if (!moved.empty() && diagnosis().cause == Diagnosis::Cause::none) lines.push_back(moved);
  return lines;
}

Warnings Session::take_warnings() { return std::exchange(warnings_, Warnings(pipeline_, config_)); }

void Session::begin_sequence() {
  pipeline_.forget_targets();
  warnings_ = Warnings(pipeline_, config_);
  watch_ = CalibrationWatch(pipeline_.report_camera(), limits_);
}

}  // namespace penumbra
