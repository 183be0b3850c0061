// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <penumbra/tracking/point_tracker.hpp>

#include <sim/experiments/detector.hpp>
#include <sim/experiments/method_info.hpp>
#include <sim/experiments/sensed.hpp>

namespace penumbra::sim {

/// What came of one image. It arrives late; until then nobody acts on it.
struct PointAnswer {
  std::optional<PointEstimate> estimate;  ///< in the base frame
  Verdict verdict = Verdict::visible;
  Eigen::Vector3d surface{0, 0, 0};  ///< what was measured, in the base frame; with an estimate
};

/// One way of following a wrist that the robot hides at times: a key point's place in space comes
/// from the depth about it.
class PointMethod {
 public:
  static constexpr double radius = 5.0;  ///< pixels about the key point that are looked at

  PointMethod(const Cell& cell, const PointTrackerConfig& tracker);
  virtual ~PointMethod() = default;

  [[nodiscard]] virtual MethodInfo info() const = 0;

  /// Called once per image with a key point, in their order, with what the method knows when the
  /// image is taken.
  virtual PointAnswer look(const Sensed& sensed, const Keypoint& keypoint) = 0;

  /// Called when an answer with an estimate arrives, in the order of arrival.
  virtual Outcome take(const PointAnswer& answer);

  /// Where the wrist is now.
  [[nodiscard]] virtual TrackedPoint at(std::int64_t stamp) const;

 protected:
  [[nodiscard]] const Cell& cell() const { return *cell_; }

  /// The wrist's centre where its surface was measured at this depth, metres; visible.
  [[nodiscard]] PointAnswer wrist_at(const Sensed& sensed, const Keypoint& keypoint,
                                     double depth) const;

  /// The point of this depth on a key point's ray, in the base frame.
  [[nodiscard]] Eigen::Vector3d point_at(const Keypoint& keypoint, double depth) const;

 private:
  const Cell* cell_;
  PointTracker tracker_;
};

/// Every method of experiment 2, the last of them ours. All trackers have the same configuration,
/// but for the worst verdict that they take, and hold the last accepted position.
[[nodiscard]] std::vector<std::unique_ptr<PointMethod>> make_point_methods(const Cell& cell);

/// What all trackers of experiment 2 are.
[[nodiscard]] PointTrackerConfig handover_tracker();

}  // namespace penumbra::sim
