// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <penumbra/tracking/pose_tracker.hpp>

#include <sim/experiments/detector.hpp>
#include <sim/experiments/method_info.hpp>
#include <sim/experiments/pose_estimator.hpp>
#include <sim/experiments/sensed.hpp>

namespace penumbra::sim {

/// The estimator that all methods share.
struct Perception {
  const PoseEstimator* estimator = nullptr;
  Acceptance acceptance = Acceptance::careful;
};

/// What came of one image. It arrives late; until then nobody acts on it.
struct PoseAnswer {
  std::optional<PoseEstimate> estimate;  ///< in the base frame
  Verdict verdict = Verdict::visible;
};

/// What a method may look at.
struct PoseView {
  const Sensed& sensed;
  const Detection& detection;
  std::span<const FeatureMatch> matches;  ///< in the whole detected box
};

/// One way of following an object that the robot hides at times.
class PoseMethod {
 public:
  PoseMethod(const Cell& cell, const Perception& perception, const PoseTrackerConfig& tracker);
  virtual ~PoseMethod() = default;

  [[nodiscard]] virtual MethodInfo info() const = 0;

  /// Called once per image in which the object was detected, in their order, with what the method
  /// knows when the image is taken.
  virtual PoseAnswer look(const PoseView& view) = 0;

  /// Called when an answer arrives, in the order of arrival.
  virtual Outcome take(const PoseAnswer& answer);

  /// Where the object is now.
  [[nodiscard]] virtual TrackedPose at(std::int64_t stamp) const;

 protected:
  [[nodiscard]] const Cell& cell() const { return *cell_; }

  /// Of the pixels of a mask.
  [[nodiscard]] std::optional<PoseEstimate> estimate(const PoseView& view,
                                                     ImageView<const std::uint8_t> mask) const;

 private:
  const Cell* cell_;
  Perception perception_;
  PoseTracker tracker_;
};

/// Every method of experiment 1, the last of them ours. All trackers have the same configuration,
/// but for the worst verdict that they take.
[[nodiscard]] std::vector<std::unique_ptr<PoseMethod>> make_pose_methods(
    const Cell& cell, const Perception& perception);

/// What all trackers of experiment 1 know: a conveyor's direction, not its speed.
[[nodiscard]] PoseTrackerConfig conveyor_tracker(const Cell& cell);

}  // namespace penumbra::sim
