// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <penumbra/tracking/gaussian-inl.hpp>
#include <penumbra/tracking/point_filter-inl.hpp>
#include <penumbra/tracking/point_tracker.hpp>
#include <penumbra/tracking/track_history-inl.hpp>
#include <penumbra/tracking/track_rules-inl.hpp>

namespace penumbra {

using detail::PointFilter;

void PointTrackerConfig::check() const {
  constexpr const char* name = "PointTrackerConfig";
  detail::require_positive(name, "sigma", sigma);
  detail::require_not_negative(name, "acceleration", acceleration);
  detail::require_not_negative(name, "speed_sigma", speed_sigma);
  detail::require_not_negative(name, "held_speed", held_speed);
  detail::check_rules(name, detail::rules_of(*this));
}

struct PointTracker::State {
  explicit State(const PointTrackerConfig& given)
      : config(given), history(PointFilter(given), detail::rules_of(given)) {}

  PointTrackerConfig config;
  detail::TrackHistory<PointFilter> history;
};

PointTracker::PointTracker(const PointTrackerConfig& config) {
  config.check();
  state_ = std::make_unique<State>(config);
}
PointTracker::~PointTracker() = default;
PointTracker::PointTracker(PointTracker&&) noexcept = default;
PointTracker& PointTracker::operator=(PointTracker&&) noexcept = default;

Outcome PointTracker::update(const PointEstimate& estimate, Verdict verdict) {
  const double variance = state_->config.sigma * state_->config.sigma;
  const Eigen::Matrix3d covariance =
      estimate.covariance.value_or(variance * Eigen::Matrix3d::Identity());
  if (!estimate.position.allFinite() || !detail::is_covariance<3>(covariance)) {
    return Outcome::refused_invalid;
  }
  if (!detail::good_enough(verdict, state_->config.worst)) return Outcome::refused_verdict;
  return state_->history.take(estimate.stamp, {estimate.position, covariance});
}

TrackedPoint PointTracker::at(std::int64_t stamp) const {
  const auto recall = state_->history.at(stamp);
  if (!recall) return {};
  TrackedPoint point;
  point.source = detail::source_of(*recall, state_->config.motion == PointMotion::hold);
  point.age = recall->age;
  point.position = recall->state.position;
  point.velocity = recall->state.velocity;
  point.covariance = detail::symmetric<3>(recall->state.covariance.topLeftCorner<3, 3>());
  return point;
}

void PointTracker::reset() { state_->history.reset(); }

}  // namespace penumbra
