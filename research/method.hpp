// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/tracking/trackers.hpp>

#include <research/cell.hpp>
#include <research/detectors.hpp>
#include <research/follower.hpp>
#include <research/pose_estimator.hpp>

namespace penumbra::research {

/// What a method gets of one image in which the target was detected.
struct View {
  const Observation& observed;
  /// Metres: above this height the height threshold takes all points for robot.
  double plane = 0;
  Detection detection = {};                    ///< conveyor
  std::span<const FeatureMatch> matches = {};  ///< conveyor: in the whole detected box
  Eigen::Vector2d keypoint{0, 0};              ///< handover: pixel of the wrist
};

/// A way to follow a target that the robot hides at times.
struct Method {
  std::string key;   ///< in metrics.json
  std::string name;  ///< in tables
  std::unique_ptr<Follower> follower;
  /// Called once per view, in the order of their images. The follower has what arrived by then.
  std::function<Answer(const View& view, const Follower& follower)> look;
};

/// The methods of the conveyor experiment. Penumbra's are the last. All trackers have the same
/// configuration, except for the worst verdict that they accept. `cell` and `estimator` must
/// outlive the methods.
[[nodiscard]] std::vector<Method> make_pose_methods(const Cell& cell,
                                                    const PoseEstimator& estimator,
                                                    Acceptance acceptance);

/// The same for the handover experiment.
[[nodiscard]] std::vector<Method> make_point_methods(const Cell& cell);

}  // namespace penumbra::research
