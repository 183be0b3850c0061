// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <research/follower.hpp>

namespace penumbra::research {
namespace {

class LastEstimate : public Follower {
 public:
  TrackedPose at(std::int64_t stamp) const override {
    TrackedPose pose;
    if (!last_) return pose;
    pose.source = Source::held;
    pose.age = static_cast<double>(stamp - last_->stamp) * 1e-9;
    pose.pose = last_->pose;
    return pose;
  }

 protected:
  bool take(const PoseEstimate& estimate, Verdict /*verdict*/) override {
    if (!last_ || estimate.stamp > last_->stamp) last_ = estimate;
    return true;
  }

 private:
  std::optional<PoseEstimate> last_;
};

class PoseFollower : public Follower {
 public:
  explicit PoseFollower(const PoseTrackerConfig& config) : tracker_(config) {}
  TrackedPose at(std::int64_t stamp) const override { return tracker_.at(stamp); }

 protected:
  bool take(const PoseEstimate& estimate, Verdict verdict) override {
    return tracker_.update(estimate, verdict) == Outcome::accepted;
  }

 private:
  PoseTracker tracker_;
};

class PointFollower : public Follower {
 public:
  explicit PointFollower(const PointTrackerConfig& config) : tracker_(config) {}
  TrackedPose at(std::int64_t stamp) const override {
    const TrackedPoint point = tracker_.at(stamp);
    TrackedPose pose;
    pose.source = point.source;
    pose.age = point.age;
    pose.pose.translation() = point.position;
    return pose;
  }

 protected:
  bool take(const PoseEstimate& estimate, Verdict verdict) override {
    const PointEstimate point{.stamp = estimate.stamp, .position = estimate.pose.translation()};
    return tracker_.update(point, verdict) == Outcome::accepted;
  }

 private:
  PointTracker tracker_;
};

}  // namespace

void Follower::post(std::int64_t arrival, const Answer& answer, const Event& event) {
  late_.push_back({arrival, answer, event});
}

void Follower::deliver(std::int64_t now, std::vector<Event>& events) {
  const auto first = std::stable_partition(late_.begin(), late_.end(),
                                           [&](const Late& l) { return l.arrival > now; });
  std::stable_sort(first, late_.end(),
                   [](const Late& a, const Late& b) { return a.arrival < b.arrival; });
  for (auto late = first; late != late_.end(); ++late) {
    const Answer& answer = late->answer;
    if (answer.estimate) late->event.accepted = take(*answer.estimate, answer.verdict);
    events.push_back(late->event);
  }
  late_.erase(first, late_.end());
}

std::unique_ptr<Follower> make_last_estimate() { return std::make_unique<LastEstimate>(); }

std::unique_ptr<Follower> make_follower(const PoseTrackerConfig& config) {
  return std::make_unique<PoseFollower>(config);
}

std::unique_ptr<Follower> make_follower(const PointTrackerConfig& config) {
  return std::make_unique<PointFollower>(config);
}

}  // namespace penumbra::research
