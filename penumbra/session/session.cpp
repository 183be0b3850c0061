// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/planning/plan_forecast.hpp>
#include <penumbra/session/scan_image-inl.hpp>
#include <penumbra/session/session.hpp>
#include <penumbra/session/warnings.hpp>

namespace penumbra {

Session::Session(Robot robot, const Camera& camera, const PipelineConfig& config,
                 const DriftLimits& limits)
    : pipeline_(std::move(robot), camera, config),
      config_(config),
      camera_(camera),
      limits_(limits),
      warnings_(new_warnings()),
      watch_(std::in_place, pipeline_.report_camera(), limits_),
      forecast_(
          std::make_unique<PlanForecast>(pipeline_.robot(), pipeline_.report_camera(), config)) {}

Session::Session(Pipeline of_scans, std::shared_ptr<ScanImage> scan, const DriftLimits& limits)
    : pipeline_(std::move(of_scans)),
      scan_(std::move(scan)),
      limits_(limits),
      warnings_(new_warnings()) {}

Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

std::unique_ptr<Warnings> Session::new_warnings() const {
  return config_ ? std::make_unique<Warnings>(pipeline_, *camera_, *config_)
                 : std::make_unique<Warnings>(pipeline_.robot());
}

const Diagnosis& Session::diagnosis() const { return warnings_->diagnosis(); }

std::size_t Session::poses() const { return warnings_->poses(); }

const FrameReport& Session::process(const Frame& frame) {
  const bool has_forecasts = frame.plan && forecast_;
  const FrameReport& report =
      pipeline_.process(frame, has_forecasts ? forecast_->of(frame) : std::span<const Forecast>());
  warnings_->add(report, frame);
  if (scan_ && scan_->take(report, frame)) {
    warnings_->add(*scan_);
    if (!watch_) watch_.emplace(scan_->camera(), limits_, false);
    if (watch_->compares_next()) scan_->draw();
    watch_->add(scan_->report());
  }
  if (watch_ && !scan_) watch_->add(report);
  return report;
}

const Drift& Session::drift() const {
  static const Drift none;
  return watch_ ? watch_->drift() : none;
}

std::vector<std::string> Session::warnings() const {
  std::vector<std::string> lines = warnings_->lines();
  const std::string moved = drift().message();
  if (!moved.empty() && diagnosis().cause == Diagnosis::Cause::none) lines.push_back(moved);
  return lines;
}

std::function<std::vector<std::string>()> Session::take_warnings() {
  return [taken = std::shared_ptr(std::exchange(warnings_, new_warnings()))] {
    return taken->lines();
  };
}

void Session::begin_sequence() {
  pipeline_.forget_targets();
  warnings_ = new_warnings();
  watch_.reset();
  if (!scan_) watch_.emplace(pipeline_.report_camera(), limits_);
}

}  // namespace penumbra
