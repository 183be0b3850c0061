// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <penumbra/tracking/trackers.hpp>

#include <research/seed_run.hpp>

namespace penumbra::research {

/// The result of a method for one image. It arrives late.
struct Answer {
  std::optional<PoseEstimate> estimate = {};  ///< in the base frame; of a wrist only the position
  Verdict verdict = Verdict::visible;
  Eigen::Vector3d surface{0, 0, 0};  ///< handover: the measured point, in the base frame
};

/// Says where the target is, from answers that arrive late.
class Follower {
 public:
  virtual ~Follower() = default;

  /// Keeps an answer until it arrives, at a stamp in nanoseconds.
  void post(std::int64_t arrival, const Answer& answer, const Event& event);

  /// Takes the answers that have arrived by now, in the order of arrival, those of one stamp in the
  /// order of their images. Adds their events to `events`.
  void deliver(std::int64_t now, std::vector<Event>& events);

  /// Returns where the target is at a stamp.
  [[nodiscard]] virtual TrackedPose at(std::int64_t stamp) const = 0;

 protected:
  /// Returns whether the estimate is accepted.
  virtual bool take(const PoseEstimate& estimate, Verdict verdict) = 0;

 private:
  struct Late {
    std::int64_t arrival;
    Answer answer;
    Event event;
  };
  std::vector<Late> late_;
};

/// Returns a follower that gives the newest estimate as it is.
[[nodiscard]] std::unique_ptr<Follower> make_last_estimate();
/// Returns a follower with Penumbra's tracker of poses.
[[nodiscard]] std::unique_ptr<Follower> make_follower(const PoseTrackerConfig& config);
/// Returns a follower with Penumbra's tracker of points.
[[nodiscard]] std::unique_ptr<Follower> make_follower(const PointTrackerConfig& config);

}  // namespace penumbra::research
