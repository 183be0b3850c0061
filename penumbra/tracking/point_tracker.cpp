// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include <Eigen/Core>

#include <penumbra/tracking/gaussian.hpp>
#include <penumbra/tracking/track_history-inl.hpp>
#include <penumbra/tracking/trackers.hpp>

namespace penumbra {
namespace detail {

/// A Kalman filter of position and velocity under white acceleration (Bar-Shalom, Li, Kirubarajan
/// 2001, section 6.2.2, "continuous white noise acceleration"). A point that is held has a constant
/// unknown velocity of mean 0, and each accepted position restarts it.
class PointFilter {
 public:
  struct State {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  };
  struct Measurement {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };

  explicit PointFilter(const PointTrackerConfig& config);

  [[nodiscard]] State begin(const Measurement& measurement) const;
  [[nodiscard]] State predicted(const State& state, double seconds) const;
  [[nodiscard]] double distance(const State& state, const Measurement& measurement) const;
  void correct(State& state, const Measurement& measurement) const;

 private:
  bool hold_;
  double density_;   // of white acceleration, squared
  double variance_;  // of an unknown velocity
};

PointFilter::PointFilter(const PointTrackerConfig& config)
    : hold_(config.motion == PointMotion::hold),
      density_(hold_ ? 0.0 : config.acceleration * config.acceleration),
      variance_(hold_ ? config.held_speed * config.held_speed
                      : config.speed_sigma * config.speed_sigma) {}

PointFilter::State PointFilter::begin(const Measurement& measurement) const {
  State state;
  state.position = measurement.position;
  state.covariance.topLeftCorner<3, 3>() = measurement.covariance;
  state.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(variance_);
  return state;
}

PointFilter::State PointFilter::predicted(const State& state, double seconds) const {
  const double t = seconds;
  State later = state;
  later.position += t * state.velocity;
  auto& p = later.covariance;
  p.topRows<3>() += t * p.bottomRows<3>();
  p.leftCols<3>() += t * p.rightCols<3>();
  p.topLeftCorner<3, 3>().diagonal().array() += density_ * t * t * t / 3;
  p.topRightCorner<3, 3>().diagonal().array() += density_ * t * t / 2;
  p.bottomLeftCorner<3, 3>().diagonal().array() += density_ * t * t / 2;
  p.bottomRightCorner<3, 3>().diagonal().array() += density_ * t;
  return later;
}

double PointFilter::distance(const State& state, const Measurement& measurement) const {
  const Eigen::Matrix3d total = state.covariance.topLeftCorner<3, 3>() + measurement.covariance;
  const Eigen::Vector3d residual = measurement.position - state.position;
  return squared_distance(total, residual);
}

void PointFilter::correct(State& state, const Measurement& measurement) const {
  if (hold_) {
    state = begin(measurement);
    return;
  }
  const Eigen::Vector3d residual = measurement.position - state.position;
  const Eigen::Matrix<double, 6, 1> change =
      kalman_correction(state.covariance, measurement.covariance, residual);
  state.position += change.head<3>();
  state.velocity += change.tail<3>();
}

}  // namespace detail

using detail::PointFilter;

void PointTrackerConfig::check() const { check_settings(*this); }

struct PointTracker::State {
  explicit State(const PointTrackerConfig& given)
      : config(given), history(PointFilter(given), given) {}

  PointTrackerConfig config;
  detail::TrackHistory<PointFilter, PointTrackerConfig> history;
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
  if (!estimate.position.allFinite() || !detail::is_covariance(covariance)) {
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
  point.covariance = detail::symmetric(recall->state.covariance.topLeftCorner<3, 3>());
  return point;
}

void PointTracker::reset() { state_->history.reset(); }

}  // namespace penumbra
